-- Key frames: a motion as a list of poses with times. A frame ends when its motion has arrived, or earlier when its own
-- exit condition says so. For the `run` of a state:
--
--   run = function(m)
--     frames.play(m, m.posture, {
--       { pose = "squat", time_s = 0.8 },
--       { pose = { l_hip_pitch = -1 }, time_s = 0.4, hold_s = 0.2 },
--       { pose = "stand", time_s = 1.0, until_ = function() return touched() end },
--     })
--   end
local frames = {}

-- Plays the frames one after the other; each is { pose =, time_s =, hold_s = 0, until_ = function() -> boolean }.
-- A frame whose until_ turns true is left at once: its motion is cancelled where it is.
-- Returns true, or nil and why a motion failed ("queue_full", "cancelled", "expired") and the number of its frame.
function frames.play(m, object, list)
  for number, frame in ipairs(list) do
    local motion, refused = object:move(frame.pose, { time_s = frame.time_s })
    if not motion then return nil, refused, number end
    if frame.until_ then
      while not motion.done and not frame.until_() do m:wait(0) end
      if not motion.done then motion:cancel() end
    else
      local arrived, why = motion:wait()
      if not arrived and why then return nil, why, number end
    end
    if (frame.hold_s or 0) > 0 then m:wait(frame.hold_s) end
  end
  return true
end

-- How long the frames take when none is left early.
function frames.duration_s(list)
  local total_s = 0
  for _, frame in ipairs(list) do total_s = total_s + frame.time_s + (frame.hold_s or 0) end
  return total_s
end

return frames
