-- Timing with the engine's clock (s.time_s): how long a condition has held, a timer, and decisions with hysteresis.
local timing = {}

-- How long a condition has held without a break: local held = timing.held(); held(s.time_s, condition) -> seconds.
function timing.held()
  local since_s
  return function(time_s, condition)
    if not condition then
      since_s = nil
      return 0
    end
    since_s = since_s or time_s
    return time_s - since_s
  end
end

-- Counts down from duration_s: local left = timing.timer(2); left(s.time_s) -> seconds left, 0 when it is over.
function timing.timer(duration_s)
  local end_s
  return function(time_s)
    end_s = end_s or time_s + duration_s
    return math.max(0, end_s - time_s)
  end
end

-- True from `on` upwards, false from `off` downwards, what it was in between; on > off.
function timing.hysteresis(on, off)
  if not (on > off) then error(string.format("hysteresis: on (%g) must be larger than off (%g)", on, off), 2) end
  local state = false
  return function(value)
    if value >= on then state = true elseif value <= off then state = false end
    return state
  end
end

return timing
