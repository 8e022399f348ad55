-- Squats, then waves: a behavior made of other behaviors.
local k = require "kadans"
local playlist = require "playlist"

return k.behavior "show" {
  controls = "posture",
  initial  = "show",
  playlist.state("show", { k.call "squat", k.call "wave" }, {
    { on = "done", to = "done" },
    { on = "failed", to = "failed" },
  }),
  k.final "done"   { outcome = "done" },
  k.final "failed" { outcome = "failed" },
}
