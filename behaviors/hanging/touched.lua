-- Holds the legs in position while something touches a foot, and lets them hang on torque while nothing does. Both
-- switches are reflexes: the control engine makes them in the tick of the contact.
local k = require "kadans"

return k.behavior "touched" {
  controls = "loose",
  initial  = "hang",

  k.state "hang" {
    endless = true,
    enter = function(m)
      m:on({ any = { "foot.left.contact", "foot.right.contact" } }, function(c) c:use("held") end,
        { within_s = 3600, every_time = true })
      m:on({ all = { "not foot.left.contact", "not foot.right.contact" } }, function(c)
        c:use("loose")
        c.springs:move("stand", { time_s = 0.05 })
      end, { within_s = 3600, every_time = true })
    end,
  },
}
