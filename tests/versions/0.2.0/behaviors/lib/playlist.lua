-- Plays a list of behaviors inside a behavior, one after the other: a state made of k.calls.
--
--   playlist.state("show", { k.call "squat", k.call "wave" })
--
-- can stand wherever a state can. Add its transitions behind the list: { on = "done", to = "up" }.
local k = require "kadans"

local playlist = {}

-- A state that plays the calls in their order. It ends with "done" after the last, or at the first that ends with
-- "failed", with "failed". `transitions` are the state's own; without any, those two have to be taken further out.
function playlist.state(name, calls, transitions)
  if #calls == 0 then error("playlist.state: the list is empty", 2) end
  local body = { initial = "item_1" }
  for number, call in ipairs(calls) do
    local following = number < #calls and "item_" .. number + 1 or "all_done"
    body[number] = k.state("item_" .. number) {
      call,
      { on = "done", to = following },
      { on = "failed", to = "one_failed", why = "item " .. number .. " failed" },
    }
  end
  body[#body + 1] = k.final "all_done" { outcome = "done" }
  body[#body + 1] = k.final "one_failed" { outcome = "failed" }
  for _, transition in ipairs(transitions or {}) do body[#body + 1] = transition end
  return k.state(name)(body)
end

return playlist
