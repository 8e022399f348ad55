// Two joints on a board, on virtual time, with an ideal model behind them.
#pragma once

#include <cmath>
#include <cstdlib>
#include <string>

#include <doctest/doctest.h>

#include "kadans/plant/ideal_world.h"
#include "kadans/signal/input_error.h"
#include "plant/hostmot2/emulator/board_world.h"
#include "plant/two_joints.h"

namespace kadans::hostmot2::bench {

// Datagrams of a hostile test: 10^6 in a soak.
inline int hostile_count() {
  return std::getenv("KADANS_SOAK") != nullptr ? 1'000'000 : 20'000;  // NOLINT(concurrency-mt-unsafe): one thread
}

inline constexpr std::int64_t ms = 1'000'000;

inline PinSettings high(std::uint32_t number) { return {.number = number}; }
inline PinSettings low(std::uint32_t number) { return {.number = number, .low = true}; }

inline HostMot2Settings two_axes() {
  HostMot2Settings settings;
  settings.boards = {{.name = "io", .address = "192.168.1.121", .card = "7I96"}};
  DriveWiring hip{.drive = "hip", .board = "io", .encoder = 0, .pwm = 0, .counts_per_rad = 4000};
  hip.amplifier = {.full = 10, .current_max_A = 5, .Nm_per_A = 0.05, .gear = 10, .efficiency = 0.8};  // 0.4 Nm/A
  hip.position_gain_Nm_per_rad = 40;
  hip.velocity_gain_Nms_per_rad = 8;
  hip.enable = high(20);
  hip.fault = low(21);
  DriveWiring knee = hip;
  knee.drive = "knee";
  knee.encoder = knee.pwm.emplace(1);
  knee.reversed = knee.pwm_reversed = true;
  knee.enable = low(22);
  knee.fault.reset();
  settings.drives = {hip, knee};
  return settings;
}

inline PlantSite site() {
  return {.file = "robot.json",
          .layout = {.robot = "walker", .joints = {"hip", "knee"}, .feet = {}, .sensors = {"lid"}}};
}

struct Bench {
  // `there`: what the boards are, where that is not what the driver's configuration says.
  explicit Bench(const HostMot2Settings& settings = two_axes(), const HostMot2Settings* there = nullptr)
      : world(std::make_unique<IdealWorld>(test::two_joints(), PlantSettings{.position_rad = {0.1, -0.2}}), settings,
              there == nullptr ? settings : *there, site()) {}

  void run(const JointActuation& first, const JointActuation& second, int milliseconds) {
    actuation.joint_count = 2;
    actuation.joints[0] = first;
    actuation.joints[1] = second;
    for (int i = 0; i < milliseconds; ++i) {
      world.read(sensors);
      world.write(actuation);
      world.step(ms);
    }
    world.read(sensors);
  }
  void order(std::size_t joint, DriveOrder what) {
    actuation.drives[joint] = {what, static_cast<std::uint8_t>(actuation.drives[joint].number + 1)};
  }
  std::uint64_t count(std::string_view name) {
    for (const PlantCount& one : world.driver().link_counts()) {
      if (one.name == name) return one.value;
    }
    FAIL_CHECK(name);
    return 0;
  }
  std::string why_not() {
    try {
      world.start();
    } catch (const InputError& error) {
      return error.what();
    }
    return "";
  }
  EmulatedBoard& board() { return world.machine().board(0); }

  hostmot2::BoardWorld world;
  ActuationFrame actuation;
  SensorFrame sensors;
};

inline constexpr JointActuation off{};
inline JointActuation effort(double Nm) { return {.effort_Nm = Nm, .mode = ActuationMode::effort}; }
inline JointActuation position(double rad) { return {.position_rad = rad, .mode = ActuationMode::position}; }
inline JointActuation velocity(double rad_s) { return {.velocity_rad_s = rad_s, .mode = ActuationMode::velocity}; }

inline bool has(const std::string& text, std::string_view part) { return text.find(part) != std::string::npos; }

}  // namespace kadans::hostmot2::bench
