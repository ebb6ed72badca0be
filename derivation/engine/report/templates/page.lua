-- Pandoc filter: add numbers of sections, equations, tables and figures; resolve references; reject
-- unknown commands.

local letters, chapter, part = false, 0, 0
local headings, equations, tables, figures = 0, 0, 0, 0
local numbers, sources, cited = {}, {}, 0

local function stop(text)
  error("no HTML for " .. text, 0)
end

local function span(class, content)
  return pandoc.Span(content, { class = class })
end

-- First pass, in the order of the text: numbers.

local function number(heading)
  if heading.level == 1 then
    chapter, part = chapter + 1, 0
    return letters and string.char(64 + chapter) or tostring(chapter)
  end
  part = part + 1
  return (letters and string.char(64 + chapter) or chapter) .. "." .. part
end

local function Header(heading)
  if not heading.classes:includes("unnumbered") then
    numbers[heading.identifier] = number(heading)
    heading.content = pandoc.Inlines({ span("count", numbers[heading.identifier]), pandoc.Space() })
      .. heading.content
  elseif heading.level > 1 then
    heading.classes:insert("unlisted")
  end
  heading.level = heading.level + 1
  return heading
end

local function Math(formula)
  if formula.mathtype == "InlineMath" then
    return nil
  end
  local label, body = formula.text:match("^\\begin{equation}%s*\\label{(.-)}(.*)\\end{equation}$")
  local shown = span("wide", { pandoc.Math("DisplayMath", body or formula.text) })
  if not label then
    return shown, false
  end
  equations = equations + 1
  numbers[label] = tostring(equations)
  local count = span("count", "(" .. equations .. ")")
  return pandoc.Span({ shown, count }, { id = label, class = "equation" }), false
end

local function counted(word, count, caption)
  if #caption.long > 0 then
    caption.long[1].content = pandoc.Inlines(word .. " " .. count .. ": ") .. caption.long[1].content
  end
end

local function Figure(figure)
  figures = figures + 1
  local words = pandoc.utils.stringify(figure.caption.long)
  counted("Figure", figures, figure.caption)
  figure.attributes["latex-placement"] = nil
  return figure:walk({
    Image = function(image)
      image.attr = { ["aria-label"] = words }
      return image
    end,
  })
end

-- Mark columns of text, and remove column widths, which the browser computes.
local function Table(found)
  if #found.caption.long > 0 then
    tables = tables + 1
    counted("Table", tables, found.caption)
  end
  local text = {}
  for place, spec in ipairs(found.colspecs) do
    text[place] = spec[2] ~= nil
    found.colspecs[place] = { spec[1], nil }
  end
  for _, body in ipairs(found.bodies) do
    for _, row in ipairs(body.body) do
      for place, cell in ipairs(row.cells) do
        if cell.col_span > 1 then
          cell.classes:insert("across")
        elseif text[place] then
          cell.classes:insert("text")
        end
      end
    end
  end
  return pandoc.Div({ found }, { class = "wide" }), false
end

local function Div(block)
  letters = letters or block.identifier == "appendix"
  chapter = block.identifier == "appendix" and 0 or chapter
  local key = block.identifier:match("^source%-(.*)")
  if key then
    cited = cited + 1
    sources[key] = tostring(cited)
  end
end

local function bare(cite)
  cite.content = {}
  return cite
end

-- Second pass: references, commands, and punctuation, which must not be separated from a formula.

local function link(text, target)
  return pandoc.Link(text, "#" .. target)
end

local function Cite(cite)
  local found = pandoc.Inlines("[")
  for place, citation in ipairs(cite.citations) do
    local count = sources[citation.id] or stop("\\cite{" .. citation.id .. "}")
    found:extend(pandoc.Inlines(place > 1 and ", " or ""))
    found:insert(link(count, "source-" .. citation.id))
  end
  found:insert(pandoc.Str("]"))
  return found
end

local function raw(element)
  local label = element.text:match("^\\ref{(.*)}$")
  if label then
    return link(numbers[label] or stop(element.text), label)
  elseif element.text:match("^\\allowbreak") then
    return pandoc.RawInline("html", "<wbr>")
  elseif element.text:match("^\\[be]group%s*$") then
    return {}
  elseif element.format:match("tex$") then
    stop(element.text)
  end
end

local function Inlines(list)
  local found = pandoc.Inlines({})
  for _, element in ipairs(list) do
    local last = found[#found]
    local point, rest = (element.text or ""):match("^([.,;:)%]]+)(.*)$")
    if element.t == "Str" and point and last and last.t == "Math" then
      found[#found] = span("bound", { last, pandoc.Str(point) })
      element = pandoc.Str(rest)
    end
    if element.t ~= "Str" or element.text ~= "" then
      found:insert(element)
    end
  end
  return found
end

return {
  {
    traverse = "topdown",
    Header = Header, Math = Math, Figure = Figure, Table = Table, Div = Div, Cite = bare,
  },
  { Cite = Cite, RawInline = raw, RawBlock = raw, Inlines = Inlines },
}
