function tree = h5info(file)
% As MATLAB's. Releases differ in the text of an attribute: OPSHOCK_TEXT=cell returns it as a cell, else as characters.
    tree = text_as(h5_contents(file));
end

function item = text_as(item)
    for k = 1:numel(item.Attributes)
        value = item.Attributes(k).Value;
        if iscell(value) && ~strcmp(getenv('OPSHOCK_TEXT'), 'cell')
            item.Attributes(k).Value = value{1};
        end
    end
    for inner = {'Groups', 'Datasets'}
        if isfield(item, inner{1})
            for k = 1:numel(item.(inner{1}))
                item.(inner{1})(k) = text_as(item.(inner{1})(k));
            end
        end
    end
end
