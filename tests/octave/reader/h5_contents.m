function [tree, values] = h5_contents(file)
% What an HDF5 file holds: TREE as h5info returns it, VALUES a map from the paths of datasets to their values.
% dump.py beside this file does the reading; what it found is kept for the next call.
    persistent known
    if isempty(known)
        known = containers.Map();
    end
    file = make_absolute_filename(file);
    key = sprintf('%s %.17g', file, stat(file).mtime);
    if ~isKey(known, key)
        dump = fullfile(fileparts(mfilename('fullpath')), 'dump.py');
        aside = tempname();
        command = sprintf('"%s" "%s" "%s" "%s"', getenv('OPSHOCK_PYTHON'), dump, file, aside);
        [code, said] = system(command);
        assert(code == 0, 'dump.py: %s', said);
        from = fopen(aside, 'r');
        values = containers.Map();
        tree = read_group(from, split(fgetl(from)), values);
        fclose(from);
        delete(aside);
        tree.Filename = file;
        known(key) = {tree, values};
    end
    kept = known(key);
    [tree, values] = kept{:};
end

function words = split(line)
    words = strsplit(line, "\t", 'CollapseDelimiters', false);
end

function tree = read_group(from, words, values)
    path = words{2};
    tree = struct('Name', path, 'Groups', [], 'Datasets', [], 'Attributes', []);
    in_dataset = false;
    while true
        words = split(fgetl(from));
        switch words{1}
            case 'end'
                return
            case 'group'
                tree.Groups = [tree.Groups; read_group(from, words, values)];
            otherwise
                [value, sizes, class] = read_values(from, words);
                item = struct('Name', words{2}, 'Datatype', struct('Class', class), ...
                    'Dataspace', struct('Size', sizes));
                if strcmp(words{1}, 'attribute')
                    item.Value = value;
                    if in_dataset
                        tree.Datasets(end).Attributes = [tree.Datasets(end).Attributes; item];
                    else
                        tree.Attributes = [tree.Attributes; item];
                    end
                else
                    in_dataset = true;
                    item.Attributes = [];
                    tree.Datasets = [tree.Datasets; item];
                    values(strrep([path '/' words{2}], '//', '/')) = value;
                end
        end
    end
end

function [value, sizes, class] = read_values(from, words)
    is_scalar = strcmp(words{4}, 'scalar');
    sizes = 1;
    if ~is_scalar
        % MATLAB's first dimension is the file's last.
        sizes = fliplr(str2double(strsplit(words{4}, ',')));
    end
    n = prod(sizes);
    if strcmp(words{3}, 'text')
        class = 'H5T_STRING';
        value = cell(n, 1);
        for k = 1:n
            value{k} = fread(from, [1, str2double(fgetl(from))], 'uint8=>char');
        end
    else
        class = 'H5T_INTEGER';
        if strcmp(words{3}, 'double') || strcmp(words{3}, 'single')
            class = 'H5T_FLOAT';
        end
        value = fread(from, n, [words{3} '=>' words{3}], 0, 'ieee-le');
    end
    assert(numel(value) == n);
    value = reshape(value, [sizes 1]);
end
