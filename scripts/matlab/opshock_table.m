function [critical, units] = opshock_table(source)
%OPSHOCK_TABLE  Critical shocks of a store of opshock as a table.
%   CRITICAL = OPSHOCK_TABLE(SOURCE) reads a store's folder or its results.h5 and
%   returns a table with a row for each point of the study:
%      ramp, pulse_ms, sign    the point, and the study's further axes
%      a_crit_g                critical shock in G, NaN where none was found
%      uncertainty_g           half-width of the uncertainty interval in G
%      low_g, high_g           ends of that interval in G
%      half_min_height_g       change with half the minimum film height in G
%      survived_g, failed_g    the bracket in G
%      onset_g                 amplitude of the first touch of disk and ramp in G
%      runs                    simulations behind the answer
%      status                  ok, above_range, below_range, undecided or open
%      flags                   what a reader must know, words apart by blanks
%   A number that does not exist is NaN. Units and descriptions of the columns are
%   in the table's properties.
%
%   [CRITICAL, UNITS] = OPSHOCK_TABLE(SOURCE) returns the units as a structure too.
%   Octave has no tables: there CRITICAL is a structure with the same columns.
%
%   Example:
%      critical = opshock_table('my-drive.opshock');
%      worst = min(critical.a_crit_g)
%
%   See also OPSHOCK_READ.

    file = char(source);
    if isfolder(file)
        file = fullfile(file, 'results.h5');
    end
    [data, about] = opshock_read(file);
    if ~isfield(about.attributes, 'format') || ~strcmp(about.attributes.format, 'opshock results')
        error('opshock:format', '%s holds no critical shocks: it is no results.h5 of a store', file);
    end

    critical = struct();
    units = struct();
    says = struct();
    take({'ramp', 'pulse_ms', 'sign'}, data.points, about.points);
    if isfield(data.points, 'axes')
        take(fieldnames(data.points.axes)', data.points.axes, about.points.axes);
    end
    take({'a_crit_g', 'uncertainty_g'}, data.points, about.points);
    ends = {'low_g', -1, 'lower'; 'high_g', 1, 'upper'};
    for k = 1:2
        name = ends{k, 1};
        critical.(name) = critical.a_crit_g + ends{k, 2} * critical.uncertainty_g;
        units.(name) = units.a_crit_g;
        says.(name) = [ends{k, 3} ' end of the uncertainty interval'];
    end
    names = {'half_min_height_g', 'survived_g', 'failed_g', 'onset_g', 'runs', 'status', 'flags'};
    % Files of earlier programs lack the first one.
    take(names(isfield(data.points, names)), data.points, about.points);

    if exist('struct2table', 'file')
        critical = struct2table(critical);
        critical.Properties.VariableUnits = struct2cell(units)';
        critical.Properties.VariableDescriptions = struct2cell(says)';
    end

    function take(names, columns, of)
        for column = names
            critical.(column{1}) = columns.(column{1});
            units.(column{1}) = of.(column{1}).units;
            says.(column{1}) = of.(column{1}).description;
        end
    end
end
