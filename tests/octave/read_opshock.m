% Every number that opshock_read and opshock_table give is that of `opshock report` and of the history as CSV, to the
% bit, and the lines of docs/matlab.md run. Started by tests/octave/run in a folder with the files.
%
% Octave 7 has no h5info, h5read and h5readatt: those of reader/ stand in, whose bytes come from h5py. What is tested is
% the logic of our functions and what the files hold, not MATLAB's reader. Octave's own `load -hdf5`, which reads
% numbers alone, is held against them where it can.
1;

function yes = same_bits(a, b)
    a = double(a(:));
    b = double(b(:));
    yes = numel(a) == numel(b) && all(typecast(a, 'uint64') == typecast(b, 'uint64') | (isnan(a) & isnan(b)));
end

% Texts of a key in every point of the report, in order.
function found = of_points(json, key)
    from = strfind(json, '"points": [')(1);
    to = from + strfind(json(from:end), "\n  ]")(1);
    found = regexp(json(from:to), ["\n      \"" key '": "?([^\n]*?)"?,?(?=\n)'], 'tokens');
    found = cellfun(@(one) one{1}, found(:), 'UniformOutput', false);
end

% Columns of a CSV file by their names; an empty cell is NaN.
function columns = csv(file)
    lines = strsplit(strtrim(fileread(file)), "\n");
    names = strsplit(lines{1}, ',');
    cells = strsplit(strjoin(lines(2:end), ','), ',', 'CollapseDelimiters', false);
    numbers = reshape(str2double(cells), numel(names), [])';
    for k = 1:numel(names)
        columns.(names{k}) = numbers(:, k);
    end
end

% Datasets of a file, each with units and description, and how many numbers they hold.
function [n, numbers] = datasets(data, about)
    n = 0;
    numbers = 0;
    assert(isfield(about.attributes, 'description'));
    for name = fieldnames(data)'
        [item, its] = deal(data.(name{1}), about.(name{1}));
        if isstruct(item)
            [inner, more] = datasets(item, its);
            n = n + inner;
            numbers = numbers + more;
        else
            assert(ischar(its.units) && ischar(its.description), name{1});
            assert(iscell(item) == strcmp(its.units, 'text'), name{1});
            n = n + 1;
            numbers = numbers + isnumeric(item) * numel(item);
        end
    end
end

% Blocks of lines for MATLAB on the page.
function blocks = lines_of_page()
    parts = strsplit(fileread(getenv('OPSHOCK_PAGE')), '```');
    blocks = parts(strncmp(parts, "matlab\n", 7));
    blocks = cellfun(@(block) block(8:end), blocks, 'UniformOutput', false);
end

function run_block(lines)
    eval([lines "\n"]);
end

warning('off', 'all');
set(0, 'defaultfigurevisible', 'off');
addpath('scripts/matlab');
json = fileread('report.json');

% The table against the report as JSON.
[critical, units] = opshock_table('my-drive.opshock');
[data, about] = opshock_read('my-drive.opshock/results.h5');
n_points = numel(of_points(json, 'status'));
n_equal = 0;
numbers = {'pulse_ms', 'clearance_um', 'a_crit_g', 'uncertainty_g', 'half_min_height_g', 'survived_g', 'failed_g', 'onset_g', 'runs'};
for key = numbers
    % null is NaN
    reported = str2double(of_points(json, key{1}));
    assert(numel(reported) == n_points && same_bits(reported, critical.(key{1})), key{1});
    n_equal = n_equal + n_points;
end
for key = {'ramp', 'sign', 'status'}
    assert(isequal(of_points(json, key{1}), critical.(key{1})), key{1});
end
parsed = jsondecode(json);
for k = 1:n_points
    % No flags are [] in JSON.
    assert(isequal(cellstr(parsed.points(k).flags), strsplit(critical.flags{k}, ' ')') || ...
        (isempty(parsed.points(k).flags) && isempty(critical.flags{k})));
end
assert(n_points == 16 && isequal(sort(unique(critical.status))', {'above_range', 'ok'}));
found = strcmp(critical.status, 'ok');
assert(any(found) && all(isnan(critical.a_crit_g(~found))) && all(critical.uncertainty_g(found) > 0));
assert(same_bits(critical.low_g, critical.a_crit_g - critical.uncertainty_g));
assert(same_bits(critical.high_g, critical.a_crit_g + critical.uncertainty_g));
assert(isequal({units.a_crit_g, units.low_g, units.pulse_ms, units.clearance_um}, {'G', 'G', 'ms', 'µm'}));
assert(isequal(fieldnames(units), fieldnames(critical)));
assert(isequaln(opshock_table('my-drive.opshock/results.h5'), critical));
% Octave's jsondecode rounds by units of the last place.
decoded = [parsed.points.survived_g]';
assert(max(abs(decoded ./ critical.survived_g - 1)) < 4 * eps);
printf('text of attributes as %s\n', getenv('OPSHOCK_TEXT'));
printf('report: %d points, %d numbers equal to the bit\n', n_points, n_equal);

% The same through the report as CSV, which the program writes by other lines.
[code, text] = system('target/release/opshock report my-drive.opshock --format csv --quiet');
assert(any(code == [0 4]));
rows = strsplit(strtrim(text), "\n");
head = strsplit(rows{1}, ',');
cells = cellfun(@(row) strsplit(row, ',', 'CollapseDelimiters', false), rows(2:end), 'UniformOutput', false);
cells = vertcat(cells{:});
for key = numbers
    assert(same_bits(str2double(cells(:, strcmp(head, key{1}))), critical.(key{1})), key{1});
end

% All datasets, also those without rows.
[n, entries] = datasets(data, about);
assert(n > 60 && isequal(size(data.machine.outside.wall_s), [0 1]) && isequal(size(data.machine.outside.cause), [0 1]));
assert(numel(data.runs.verdict) == numel(data.machine.runs.wall_s));
assert(strcmp(about.attributes.format, 'opshock results') && about.attributes.format_version > 0);
printf('results.h5: %d datasets with units, %d numbers\n', n, entries);

% Histories against their CSV.
for name = {'shock', 'fields'}
    columns = csv([name{1} '.csv']);
    [history, of] = opshock_read([name{1} '.h5']);
    n_equal = 0;
    for key = fieldnames(columns)'
        assert(same_bits(history.(key{1}), columns.(key{1})), key{1});
        assert(strcmp(of.(key{1}).time, '/time_s'), of.(key{1}).time);
        n_equal = n_equal + numel(columns.(key{1}));
    end
    [n, entries] = datasets(history, of);
    printf('%s.h5: %d datasets with units; %d numbers equal to those of the CSV to the bit\n', name{1}, n, n_equal);

    native = load('-hdf5', [name{1} '.h5']);
    n_equal = 0;
    for key = fieldnames(native)'
        values = native.(key{1});
        if isstruct(values)
            for inner = fieldnames(values)'
                sizes = size(history.(key{1}).(inner{1}));
                % Vectors are rows there.
                assert(numel(sizes) == 2 || isequal(size(values.(inner{1})), sizes), inner{1});
                assert(same_bits(values.(inner{1}), history.(key{1}).(inner{1})), inner{1});
                n_equal = n_equal + numel(values.(inner{1}));
            end
        else
            assert(same_bits(values, history.(key{1})), key{1});
            n_equal = n_equal + numel(values);
        end
    end
    assert(numel(fieldnames(native)) == numel(fieldnames(history)) && n_equal == entries);
    printf('%s.h5: all %d numbers equal to those of load -hdf5 to the bit\n', name{1}, n_equal);
end
assert(isnan(history.min_clearance_m(end)) == strcmp(of.attributes.verdict, 'fails'));

% Fields: x by y by time, as the CSV has them a line for each time and cell.
columns = csv('fields-fields.csv');
field = history.fields;
sizes = size(field.pressure_pa);
assert(sizes(3) == numel(field.time_s) && isequal(size(field.gap_m), sizes));
assert(sizes(1) == numel(field.x_lines_m) - 1 && sizes(2) == numel(field.y_lines_m) - 1 && sizes(1) ~= sizes(2));
assert(same_bits(field.pressure_pa, columns.pressure_pa) && same_bits(field.gap_m, columns.gap_m));
assert(columns.x_m(1) ~= columns.x_m(2) && columns.y_m(1) == columns.y_m(2));
printf('fields: %d x %d x %d, equal to the CSV to the bit\n', sizes);

% Every kept history is that of its run.
kept = find(~cellfun(@isempty, data.runs.history))';
for k = kept
    [history, of] = opshock_read(fullfile('my-drive.opshock', data.runs.history{k}));
    row = double(data.runs.point(k)) + 1;
    assert(same_bits(of.attributes.amplitude_g, data.runs.amplitude_g(k)));
    assert(strcmp(of.attributes.verdict, data.runs.verdict{k}) && strcmp(of.attributes.point_ramp, critical.ramp{row}));
    assert(same_bits(of.attributes.point_pulse_ms, critical.pulse_ms(row)));
end
assert(numel(kept) >= 4);
printf('histories of the store: %d, each of its run\n', numel(kept));

% What holds no critical shocks is refused.
try
    opshock_table('shock.h5');
    error('not refused');
catch refused
    assert(strcmp(refused.identifier, 'opshock:format'), refused.message);
end

% The lines of the page, block by block.
blocks = lines_of_page();
assert(numel(blocks) == 6);
for k = 1:numel(blocks)
    evalc('run_block(blocks{k})');
end
assert(numel(get(0, 'children')) == 2);
printf('docs/matlab.md: %d blocks run\n', numel(blocks));
