// A robot configuration and a scenario that are right, small enough to be broken line by line.
#pragma once

namespace kadans {

inline constexpr const char* right_robot = R"({
  "name": "tulip",
  "urdf": "models/tulip/tulip.urdf",
  "engine": {
    "control_period_s": 0.001,
    "behavior_period_s": 0.01,
    "commands_per_tick_max": 300
  },
  "poses": {
    "stand": { "*_knee": 0.3, "*_hip_pitch": -0.15 }
  },
  "plant": {
    "drives": {
      "*": { "rotor_inertia_kg_m2": 0.02 },
      "*_ankle_roll": { "rotor_inertia_kg_m2": 0, "parallel_spring_Nm_per_rad": 25 }
    },
    "encoders": { "*": { "noise_rad": 1e-5 } },
    "imu": { "position_m": [0, 0, 0.1] },
    "feet": [
      {
        "link": "l_ankle_roll_link",
        "heel_inner_m": [-0.08, -0.05, -0.06],
        "heel_outer_m": [-0.08, 0.05, -0.06],
        "toe_inner_m": [0.14, -0.05, -0.06],
        "toe_outer_m": [0.14, 0.05, -0.06]
      }
    ],
    "surfaces": { "torso": { "friction": 0.4 } },
    "solver_iterations": 10,
    "self_collision": true
  },
  "start": { "pose": "stand" },
  "estimate": {
    "contact_on_N": 8,
    "contact_off_N": 4,
    "joints": { "*_shoulder_pitch": { "sample_divisor": 10 } }
  },
  "safety": {
    "limits": { "*_knee": { "upper_rad": 2.0 } },
    "hold_s": 1
  },
  "control": {
    "objects": [
      {
        "name": "posture",
        "type": "joint_pid",
        "joints": ["*"],
        "parameters": { "*.kp_Nm_per_rad": 100, "l_knee.kp_Nm_per_rad": 200 },
        "presets": { "soft": { "*.kp_Nm_per_rad": 20 } }
      },
      { "name": "arms", "type": "joint_pid", "joints": ["*_shoulder_pitch"] }
    ],
    "sets": { "posture": { "objects": ["posture"] }, "wave": { "objects": ["arms"] } },
    "initial_set": "posture"
  }
}
)";

inline constexpr const char* right_scenario = R"({
  "name": "stand",
  "robot": "config/tulip/robot.json",
  "plant": "bullet",
  "duration_s": 2.5,
  "seed": 7,
  "behaviors": ["models/tulip/tulip.urdf"],
  "checks": [
    { "name": "upright", "kind": "always", "signal": "base.tilt_rad", "max": 0.05 },
    { "name": "tall", "kind": "at_end", "signal": "base.height_m", "min": 0.7, "max": 0.9 },
    { "name": "still", "kind": "never", "signal": "base.rate_y_rad_s", "min": 1, "from_s": 1, "until_s": 2 }
  ]
}
)";

}  // namespace kadans
