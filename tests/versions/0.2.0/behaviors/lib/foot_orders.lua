-- The events that lead the behavior footwork, for its k.events and for those of who decides: both declare what goes
-- between them. Places are as the robot sees them when the event comes, x ahead and y to the left.

return {
  ["foot.go"] = {
    "walk to a place, and stand there",
    x_m = { "m", min = -30, max = 30 }, y_m = { "m", min = -30, max = 30 },
    heading_rad = { "rad", min = -7, max = 7, doc = "how it stands there, from where it points now" },
    most_m_s = { "m/s", min = 0.05, max = 0.5, optional = true },
  },
  ["foot.kick"] = {
    "go to the ball, around it, and kick it toward a place",
    x_m = { "m", min = -30, max = 30 }, y_m = { "m", min = -30, max = 30 },
    beyond_m = { "m", min = 0, max = 4, optional = true, doc = "how far beyond the place it would roll" },
  },
  ["foot.dribble"] = {
    "go to the ball, around it, and dribble it toward a place, by short kicks, without standing",
    x_m = { "m", min = -30, max = 30 }, y_m = { "m", min = -30, max = 30 },
    most_m_s = { "m/s", min = 0.1, max = 0.5, optional = true },
  },
  ["foot.turn"] = { "turn on the spot", rad_s = { "rad/s", min = -0.8, max = 0.8 } },
  ["foot.dive"] = { "throw itself to a side before the ball, and get up", left = { "", min = 0, max = 1, doc = "1: left, 0: right" } },
  ["foot.stand"] = { "stand where it is" },
}
