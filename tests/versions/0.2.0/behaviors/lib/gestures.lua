-- Gestures: states with which a behavior shows something. They are skills: gestures.NAME "state" { argument = value }.
local k = require "kadans"

local gestures = {}

gestures.through = k.skill "through" {
  doc  = "Moves a control object through poses of the robot and rests in each; ends with done, and with how many there were",
  args = k.args {
    object = { "posture", doc = "control object that moves" },
    poses  = { {}, doc = "names of the poses" },
    times  = { 1, min = 1, max = 100, doc = "how often" },
    time_s = { 1.0, min = 0.1, max = 10, unit = "s", doc = "time to each pose" },
    rest_s = { 0.2, min = 0, max = 10, unit = "s", doc = "time to rest in each pose" },
  },
  make = function(a)
    if #a.poses == 0 then error("gestures.through: poses is empty", 3) end
    return k.state "poses" {
      initial = "going",
      k.state "going" {
        run = function(m)
          for _ = 1, a.times do
            for _, pose in ipairs(a.poses) do
              m[a.object]:move(pose, { time_s = a.time_s }):wait()
              m:wait(a.rest_s)
            end
          end
        end,
        { on = "run.done", to = "gone" },
      },
      k.final "gone" { outcome = "done", result = function() return { poses = #a.poses * a.times } end },
    }
  end,
}

return gestures
