function value = h5readatt(file, path, name)
% As MATLAB's, for attributes of a group or dataset.
    item = h5info(file);
    steps = strsplit(path, '/');
    steps = steps(~cellfun(@isempty, steps));
    for k = 1:numel(steps)
        item = inner(item, steps{k});
    end
    found = strcmp({item.Attributes.Name}, name);
    assert(any(found), '%s has no attribute %s', path, name);
    value = item.Attributes(found).Value;
end

function item = inner(item, name)
    for k = 1:numel(item.Groups)
        parts = strsplit(item.Groups(k).Name, '/');
        if strcmp(parts{end}, name)
            item = item.Groups(k);
            return
        end
    end
    found = strcmp({item.Datasets.Name}, name);
    assert(any(found), 'nothing is called %s', name);
    item = item.Datasets(found);
end
