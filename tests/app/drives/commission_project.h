// JIWIY's project, for tests of `kadans commission`.
#pragma once

#include "commission_bench.h"

namespace kadans::commission_bench {

constexpr double five_degrees = 5 * 3.14159265358979 / 180;

struct Bus {
  const char *type, *robot;
};
inline constexpr Bus boards{"hm2-eth", "config/jiwiy/anything_io.json"},
    servos{"dynamixel", "config/jiwiy/servos.json"};

// A project in which the robot is wired as `robot` says, and described by mine.json.
struct Project {
  explicit Project(const Bus& bus)
      : folder(program::project_copy("commission")),
        mine(folder / "config/jiwiy/mine.json"),
        right(folder / bus.robot) {
    std::filesystem::copy_file(right, mine, std::filesystem::copy_options::overwrite_existing);
    settings = {.robot = mine.string(), .plant = bus.type, .steps = {"names", "direction"}};
    truth = {.type = bus.type, .robot = right.string()};
  }
  void change(const std::string& from, const std::string& to) { REQUIRE(program::edit(mine, from, to)); }
  void swap(const std::string& one, const std::string& other) {
    change(one, "<one>");
    change(other, one);
    change("<one>", other);
  }
  const Commissioned& commissioned() {
    go(all, settings, truth);
    return all;
  }
  // The same but for the fields that were added, which say what is the case without them.
  bool is_right() const {
    std::string text = program::read(mine);
    for (const char* added :
         {", \"reversed\": false", ",\n          \"reversed\": false", ",\n          \"pwm_reversed\": false"}) {
      for (std::size_t at = text.find(added); at != std::string::npos; at = text.find(added))
        text.erase(at, std::string_view(added).size());
    }
    return text == program::read(right);
  }

  std::filesystem::path folder, mine, right;
  CommissionSettings settings;
  Truth truth;
  Commissioned all;
};

inline void check_safe(const Seen& seen) {
  CHECK(seen.away_rad < five_degrees);
  CHECK(seen.torque_share < 0.1001);
  CHECK(seen.torque_share > 0);
}

inline void check_good(const Commissioned& all) {
  for (const std::string& one : all.report.problems) CHECK_MESSAGE(one.empty(), one);
  CHECK(!all.report.ended_early);
  check_safe(all.seen);
}

}  // namespace kadans::commission_bench
