function [data, about] = opshock_read(file)
%OPSHOCK_READ  Every dataset of a results or history file of opshock.
%   DATA = OPSHOCK_READ(FILE) returns a structure with the groups and datasets of
%   FILE: of a results file DATA.points.a_crit_g, of a history DATA.head.time_s.
%   Numbers are columns of the class in the file, NaN where there is none.
%   Text is a cell column of character vectors. A dataset of three dimensions has
%   them in MATLAB's order, the reverse of that in docs/files.md.
%
%   [DATA, ABOUT] = OPSHOCK_READ(FILE) returns in ABOUT, under the same names,
%   the attributes of every dataset: ABOUT.points.a_crit_g.units is 'G' and
%   ABOUT.points.a_crit_g.description a sentence. ABOUT.attributes has those of
%   the file, such as program_version and study, and ABOUT.points.attributes
%   those of the group points.
%
%   Example:
%      [shock, about] = opshock_read('shock.h5');
%      plot(shock.head.time_s, shock.head.min_clearance_m)
%      ylabel(about.head.min_clearance_m.units)
%
%   See also OPSHOCK_TABLE, H5INFO, H5READ.

    file = char(file);
    [data, about] = read_group(file, h5info(file));
end

function [data, about] = read_group(file, group)
    data = struct();
    about = struct('attributes', attributes_of(group));
    for k = 1:numel(group.Datasets)
        dataset = group.Datasets(k);
        name = matlab.lang.makeValidName(dataset.Name);
        data.(name) = read_dataset(file, group.Name, dataset);
        about.(name) = attributes_of(dataset);
    end
    for k = 1:numel(group.Groups)
        % The name of a group is its path.
        steps = strsplit(group.Groups(k).Name, '/');
        name = matlab.lang.makeValidName(steps{end});
        [data.(name), about.(name)] = read_group(file, group.Groups(k));
    end
end

function values = read_dataset(file, path, dataset)
    is_text = strcmp(dataset.Datatype.Class, 'H5T_STRING');
    if any(dataset.Dataspace.Size == 0)
        % Nothing to read, and no release has to show how it reads nothing.
        values = zeros(0, 1);
        if is_text
            values = cell(0, 1);
        end
        return
    end
    if path(end) ~= '/'
        path = [path '/'];
    end
    values = h5read(file, [path dataset.Name]);
    if is_text
        % A cell array in older releases, a string array in newer ones.
        values = cellstr(values);
        values = values(:);
    end
end

function attributes = attributes_of(object)
    attributes = struct();
    for k = 1:numel(object.Attributes)
        value = object.Attributes(k).Value;
        if iscell(value) || isa(value, 'string')
            value = cellstr(value);
            if isscalar(value)
                value = value{1};
            end
        end
        name = matlab.lang.makeValidName(object.Attributes(k).Name);
        attributes.(name) = value;
    end
end
