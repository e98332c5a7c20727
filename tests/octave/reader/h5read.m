function value = h5read(file, path)
% As MATLAB's, but for one thing: a dataset without entries is refused, so that nothing rests on how a release reads it.
    [~, values] = h5_contents(file);
    assert(isKey(values, path), 'no dataset %s', path);
    value = values(path);
    assert(numel(value) > 0, '%s has no entries', path);
end
