// The world model: the newest observation of each thing, put where the robot was, and nothing that is wrong.
#include "kadans/supervisor/world_model.h"

#include <cmath>
#include <limits>
#include <numbers>

#include <doctest/doctest.h>

#include "engine/tick/seen_entries.h"
#include "kadans/testing/allocation_count.h"

namespace world_model_test {

using namespace kadans;
using kadans::testing::AllocationCount;
using Answer = WorldModel::Answer;

namespace {

constexpr std::int64_t second_ns = 1'000'000'000;
constexpr std::uint32_t ball = 0, wall = 1, battery = 2;

std::vector<SeenInfo> declared() {
  const SeenField x{"x_m", "m", "ahead", -10, 10}, y{"y_m", "m", "left", -10, 10};
  return {{.name = "ball", .places = 2, .fields = {x, y}, .forget_s = 3},
          {.name = "wall", .places = 3, .fields = {x, y, {"heading_rad", "rad", "points", -7, 7}}},
          {.name = "battery", .fields = {{"charge", "", "share", 0, 1}}}};
}

// A robot that walked 1 m forward in the second from 0 to 1, and then turned left by a quarter.
OdometryPast walked() {
  OdometryPast past;
  for (int i = 0; i <= 100; ++i) past.add({i * second_ns / 100, 0.01 * i, 0, 0, 0});
  past.add({2 * second_ns, 1, 0, 0.5 * std::numbers::pi, 0});
  return past;
}

OdometryStatus now_at(const PastPose& pose) {
  return {.path_x_m = pose.x_m, .path_y_m = pose.y_m, .path_heading_rad = pose.heading_rad, .breaks = pose.breaks};
}

Observation seen(std::uint32_t entry, double time_s, std::array<double, max_seen_fields> fields) {
  return {.entry = entry, .time_ns = std::llround(1e9 * time_s), .fields = fields, .source = SeenSource::perception};
}

}  // namespace

TEST_CASE(
    "the odometry's past is straight between two poses, stands after the newest, and is nothing before the oldest") {
  OdometryPast past;
  CHECK_FALSE(past.at(0));
  past.add({100, 1, 0, 3, 0});
  past.add({200, 2, 0, -3, 4});
  past.add({150, 9, 9, 9, 9});  // not newer: not taken
  CHECK(past.size() == 2);
  CHECK_FALSE(past.at(99));
  CHECK(past.at(150)->x_m == doctest::Approx(1.5));
  CHECK(std::abs(past.at(150)->heading_rad) == doctest::Approx(std::numbers::pi));  // the short way round
  CHECK(past.at(1000)->x_m == 2);
  CHECK(past.at(1000)->breaks == 4);
  for (int i = 0; i < 1000; ++i) past.add({300 + i, 0, static_cast<double>(i), 0, 0});
  CHECK(past.size() == OdometryPast::poses_max);
  CHECK_FALSE(past.at(300));
  CHECK(past.at(1299)->y_m == 999);
}

TEST_CASE("an observation is put where the robot was, and seen from where it is now") {
  WorldModel world(declared());
  const OdometryPast past = walked();
  // At 0.5 s the robot was at 0.5 m: the ball lies at 2.5, 1 of its path.
  REQUIRE(world.observe(seen(ball, 0.5, {2, 1}), past, 2 * second_ns) == Answer::taken);
  CHECK(world.entries().entries[ball].fields[0] == doctest::Approx(2.5));
  SeenEntries shown;
  show_seen(world.entries(), now_at(*past.at(2 * second_ns)), 2 * second_ns, shown);
  // From 1, 0 and turned left by a quarter it lies 1 m ahead and 1.5 m to the right.
  CHECK(shown.entries[ball].fields[0] == doctest::Approx(1));
  CHECK(shown.entries[ball].fields[1] == doctest::Approx(-1.5));
  CHECK(shown.entries[ball].age_s == doctest::Approx(1.5));
  CHECK(shown.entries[ball].carried);
  show_seen(world.entries(), {.breaks = 1}, 2 * second_ns, shown);
  CHECK_FALSE(shown.entries[ball].carried);  // it fell meanwhile
}

TEST_CASE("a pose turns with the robot, and what is no place stays what it is") {
  WorldModel world(declared());
  const OdometryPast past = walked();
  REQUIRE(world.observe(seen(wall, 0, {1, 0, 0.25}), past, 2 * second_ns) == Answer::taken);
  REQUIRE(world.observe(seen(battery, -100, {0.5}), past, 2 * second_ns) == Answer::taken);
  SeenEntries shown;
  show_seen(world.entries(), now_at(*past.at(2 * second_ns)), 2 * second_ns, shown);
  CHECK(shown.entries[wall].fields[2] == doctest::Approx(0.25 - 0.5 * std::numbers::pi));
  CHECK(shown.entries[battery].fields[0] == 0.5);
  CHECK(shown.entries[ball].confidence == 0);
  CHECK(std::isnan(shown.entries[ball].fields[0]));
  CHECK(std::isnan(shown.entries[ball].age_s));
}

TEST_CASE("the newest observation wins, in whatever order they come") {
  WorldModel world(declared());
  const OdometryPast past = walked();
  CHECK(world.observe(seen(ball, 0.8, {2, 0}), past, second_ns) == Answer::taken);
  CHECK(world.observe(seen(ball, 0.7, {9, 0}), past, second_ns) == Answer::older);
  CHECK(world.observe(seen(ball, 0.8, {3, 0}), past, second_ns) == Answer::taken);
  CHECK(world.entries().entries[ball].fields[0] == doctest::Approx(3.8));
  CHECK(world.count(Answer::older) == 1);
}

TEST_CASE("what is wrong is refused by its reason and changes nothing") {
  WorldModel world(declared());
  const OdometryPast past = walked();
  const SeenEntries before = world.entries();
  constexpr double nan = std::numeric_limits<double>::quiet_NaN(), infinite = std::numeric_limits<double>::infinity();
  const auto answer = [&](Observation one) { return world.observe(one, past, 2 * second_ns); };
  CHECK(answer(seen(3, 1, {})) == Answer::unknown_entry);
  CHECK(answer(seen(4'000'000'000, 1, {})) == Answer::unknown_entry);
  CHECK(answer(seen(ball, 1, {nan, 0})) == Answer::not_finite);
  CHECK(answer(seen(ball, 1, {0, infinite})) == Answer::not_finite);
  CHECK(answer(seen(ball, 1, {10.5, 0})) == Answer::out_of_range);
  CHECK(answer(seen(battery, 1, {-0.1})) == Answer::out_of_range);
  CHECK(answer(seen(ball, 2.1, {1, 0})) == Answer::future);
  CHECK(answer(seen(ball, -0.5, {1, 0})) == Answer::too_old);  // before the odometry's past
  CHECK(answer(seen(ball, -1.5, {1, 0})) == Answer::too_old);  // beyond forget_s
  CHECK(answer({.entry = ball, .time_ns = std::numeric_limits<std::int64_t>::min()}) == Answer::too_old);
  CHECK(answer({.entry = ball, .time_ns = std::numeric_limits<std::int64_t>::max()}) == Answer::future);
  Observation sure = seen(ball, 1, {1, 0});
  for (const double confidence : {0.0, -1.0, 1.5}) {
    sure.confidence = confidence;
    CHECK(answer(sure) == Answer::out_of_range);
  }
  sure.confidence = nan;
  CHECK(answer(sure) == Answer::not_finite);
  CHECK(world.count(Answer::taken) == 0);
  for (std::size_t i = 0; i < max_seen; ++i) {
    CHECK(world.entries().entries[i].confidence == before.entries[i].confidence);
    CHECK(world.entries().entries[i].time_ns == before.entries[i].time_ns);
  }
}

TEST_CASE("an entry that is older than forget_s is unknown again, others stay for ever") {
  WorldModel world(declared());
  const OdometryPast past = walked();
  REQUIRE(world.observe(seen(ball, 1, {1, 0}), past, second_ns) == Answer::taken);
  REQUIRE(world.observe(seen(wall, 1, {1, 0, 0}), past, second_ns) == Answer::taken);
  world.forget(4 * second_ns);
  CHECK(world.entries().entries[ball].confidence == 1);
  world.forget(4 * second_ns + 1000);
  CHECK(world.entries().entries[ball].confidence == 0);
  world.forget(10'000 * second_ns);
  CHECK(world.entries().entries[wall].confidence == 1);
}

TEST_CASE("a robot without odometry keeps what it sees where it saw it") {
  WorldModel world(declared());
  OdometryPast past;
  past.add({0, 0, 0, 0, 0});
  REQUIRE(world.observe(seen(ball, 0.5, {2, 1}), past, second_ns) == Answer::taken);
  SeenEntries shown;
  show_seen(world.entries(), {}, second_ns, shown);
  CHECK(shown.entries[ball].fields[0] == 2);
  CHECK(shown.entries[ball].carried);
}

TEST_CASE("observing, forgetting and showing never allocate") {
  WorldModel world(declared());
  const OdometryPast past = walked();
  SeenEntries shown;
  const AllocationCount heap;
  for (int i = 0; i < 100; ++i) {
    (void)world.observe(seen(static_cast<std::uint32_t>(i % 4), 1, {1, 0, 0}), past, second_ns);
    world.forget(second_ns);
    show_seen(world.entries(), {}, second_ns, shown);
  }
  const long allocations = heap.count();
  CHECK(allocations == 0);
}

}  // namespace world_model_test
