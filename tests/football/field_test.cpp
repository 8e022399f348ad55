#include "football/field.h"

#include <algorithm>
#include <optional>
#include <stdexcept>

#include <doctest/doctest.h>

using namespace kadans::football;

TEST_CASE("the middle division's fields have the sizes of the rules") {
  const Field m = league_field(Division::middle, FieldSize::middle);
  CHECK(m.length_m == 14);
  CHECK(m.width_m == 9);
  CHECK(m.goal_area_length_m == 1);
  CHECK(m.goal_area_width_m == 4);
  CHECK(m.penalty_area_length_m == 3);
  CHECK(m.penalty_area_width_m == 6);
  CHECK(m.penalty_mark_m == 2);
  CHECK(2 * m.circle_radius_m == 3);
  CHECK(m.corner_radius_m == 0.5);
  const Field s = league_field(Division::middle, FieldSize::small);
  CHECK(s.length_m == 9);
  CHECK(s.goal_area_width_m == 3);
  CHECK(s.penalty_area_length_m == 2);
  CHECK(s.penalty_mark_m == 1.5);
  CHECK(s.corner_radius_m == 0);
  CHECK(s.goal.width_m == m.goal.width_m);
  CHECK(m.goal.width_m >= 2.4);
  CHECK(m.goal.width_m <= 2.6);
  CHECK(league_ball(Division::middle).radius_m == 0.095);
}

TEST_CASE("a division plays on its own field and the next smaller one, and every such field can be") {
  for (const Division division : {Division::small, Division::middle, Division::large}) {
    int fields = 0;
    for (const FieldSize size : {FieldSize::small, FieldSize::middle, FieldSize::large}) {
      std::optional<Field> field;
      try {
        field = league_field(division, size);
      } catch (const std::invalid_argument&) {
        continue;
      }
      CHECK(field_mistake(*field) == "");
      ++fields;
    }
    CHECK(fields == (division == Division::small ? 1 : 2));
  }
  CHECK_THROWS_WITH(league_field(Division::small, FieldSize::large),
                    "the small division does not play on the large field: small plays on small, middle on small and "
                    "middle, large on middle and large");
}

TEST_CASE("a field that cannot be is refused with the measure and why") {
  Field field = league_field(Division::middle, FieldSize::middle);
  field.goal_area_width_m = 7;
  CHECK(field_mistake(field) == "goal_area_width_m is 7, but it lies in the penalty area");
  field = league_field(Division::middle, FieldSize::middle);
  field.goal.height_m = std::nan("");
  CHECK(field_mistake(field) == "goal.height_m is nan, but goals are up to 3 m high");
  field = league_field(Division::middle, FieldSize::middle);
  field.corner_radius_m = -1;
  CHECK(field_mistake(field) == "corner_radius_m is -1, but corner arcs do not meet");
}

TEST_CASE("the markings of a field are those that are painted, and look the same from its other end") {
  const Field field = league_field(Division::middle, FieldSize::middle);
  const Markings markings = markings_of(field);
  CHECK(markings.lines.size() == 17);      // 4 around, the halfway line, 3 of each of 4 areas
  CHECK(markings.crossings.size() == 24);  // 4 corners, 4 T and 4 L at each end, 2 T and 2 X at the halfway line
  CHECK(markings.marks.size() == 3);
  CHECK(markings.posts.size() == 4);
  const auto has = [&](Point at, CrossingKind kind, double mouth_rad) {
    return std::ranges::any_of(markings.crossings, [&](const Crossing& crossing) {
      return distance(crossing.at, at) < 1e-9 && crossing.kind == kind &&
             (kind == CrossingKind::cross || std::abs(wrapped(crossing.mouth_rad - mouth_rad)) < 1e-9);
    });
  };
  for (const Crossing& crossing : markings.crossings)
    CHECK(has(mirrored(crossing.at), crossing.kind, crossing.mouth_rad + std::numbers::pi));
  const double quarter_rad = std::numbers::pi / 4;
  CHECK(has({6.975, 4.475}, CrossingKind::corner, -3 * quarter_rad));
  CHECK(has({6.975, 2.975}, CrossingKind::tee, 4 * quarter_rad));  // penalty area and goal line
  CHECK(has({4.025, 2.975}, CrossingKind::corner, -quarter_rad));  // front corner of the penalty area
  CHECK(has({6.025, -1.975}, CrossingKind::corner, quarter_rad));  // front corner of the goal area
  CHECK(has({0, 4.475}, CrossingKind::tee, -2 * quarter_rad));
  CHECK(has({0, -1.475}, CrossingKind::cross, 0));
  CHECK(std::ranges::find(markings.posts, Point{6.975, 1.35}) != markings.posts.end());
  CHECK(std::ranges::find(markings.marks, Point{-5, 0}) != markings.marks.end());
}

TEST_CASE("points turn into frames and back, and angles stay within half a turn") {
  const Pose2 frame{1, -2, 2.5};
  const Point point{-0.3, 4};
  CHECK(distance(in_frame(frame, from_frame(frame, point)), point) < 1e-12);
  const Pose2 pose = from_frame(frame, Pose2{1, 1, 3});
  CHECK(std::abs(in_frame(frame, pose).theta_rad - 3) < 1e-12);
  for (const double angle_rad : {-10.0, -3.2, 0.0, 3.2, 100.0}) {
    CHECK(wrapped(angle_rad) >= -std::numbers::pi);
    CHECK(wrapped(angle_rad) < std::numbers::pi);
    CHECK(std::abs(std::sin(wrapped(angle_rad)) - std::sin(angle_rad)) < 1e-12);
  }
}
