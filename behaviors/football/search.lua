-- The search for the ball: turns on the spot, toward where it was last, or else toward the middle of the field, and then
-- looks from another place.
local field = require "field"
local legs = require "legs"

local search = {}

local turns_rad_s = 0.75
local turns_s, walks_s = 9, 6  -- a whole turn takes 8.4 s

function search.play(m, s, pose)
  local vars = m.vars
  if not vars.searches_s or s.time_s - vars.searched_s > 1 then
    vars.searches_s = s.time_s
    local seen = vars.rolling.seen
    local last = seen and seen[#seen] or { x_m = 0, y_m = 0 }
    vars.search_side = pose and field.to_robot(pose, last).y_m < 0 and -1 or 1
  end
  vars.searched_s = s.time_s
  local since_s = (s.time_s - vars.searches_s) % (turns_s + walks_s)
  if since_s < turns_s or not pose then return legs.turn(m, s, turns_rad_s * vars.search_side) end
  local round = math.floor((s.time_s - vars.searches_s) / (turns_s + walks_s)) % 2
  local place = { x_m = (round == 0 and 0.25 or -0.25) * s.seen.me.length_m, y_m = 0 }
  legs.go(m, s, pose, place, { x_m = 0, y_m = 0 })
end

return search
