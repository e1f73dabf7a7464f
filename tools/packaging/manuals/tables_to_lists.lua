-- Tables as definition lists, for man pages: a table's first column is the term, the other columns
-- follow, each behind its heading but for the last, which is the explanation.
local insert = table.insert

function Table(table)
  local simple = pandoc.utils.to_simple_table(table)
  local items = {}
  for _, row in ipairs(simple.rows) do
    local term = row[1][1] and row[1][1].content or {}
    local facts, blocks = {}, {}
    for k = 2, #row - 1 do
      local heading = simple.headers[k][1]
      if row[k][1] then
        if #facts > 0 then insert(facts, pandoc.Str("; ")) end
        if heading then
          for _, word in ipairs(heading.content) do insert(facts, word) end
          insert(facts, pandoc.Str(": "))
        end
        for _, word in ipairs(row[k][1].content) do insert(facts, word) end
      end
    end
    for _, block in ipairs(row[#row]) do insert(blocks, pandoc.Para(block.content)) end
    if #facts > 0 then insert(blocks, pandoc.Para(facts)) end
    insert(items, { term, { blocks } })
  end
  return pandoc.DefinitionList(items)
end
