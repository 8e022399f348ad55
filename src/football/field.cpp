#include "field.h"

#include <array>
#include <cstdio>
#include <numbers>
#include <stdexcept>
#include <utility>

namespace kadans::football {
namespace {

constexpr std::array<Field, 3> sizes{{
    {.length_m = 9,
     .width_m = 6,
     .goal_area_length_m = 1,
     .goal_area_width_m = 3,
     .penalty_area_length_m = 2,
     .penalty_area_width_m = 4,
     .penalty_mark_m = 1.5,
     .circle_radius_m = 0.75,
     .corner_radius_m = 0,
     .border_m = 1,
     .line_m = 0.05,
     .mark_m = 0.1},
    {.length_m = 14,
     .width_m = 9,
     .goal_area_length_m = 1,
     .goal_area_width_m = 4,
     .penalty_area_length_m = 3,
     .penalty_area_width_m = 6,
     .penalty_mark_m = 2,
     .circle_radius_m = 1.5,
     .corner_radius_m = 0.5,
     .border_m = 1,
     .line_m = 0.05,
     .mark_m = 0.1},
    {.length_m = 22,
     .width_m = 14,
     .goal_area_length_m = 1,
     .goal_area_width_m = 5,
     .penalty_area_length_m = 3.5,
     .penalty_area_width_m = 7,
     .penalty_mark_m = 2.5,
     .circle_radius_m = 2,
     .corner_radius_m = 1,
     .border_m = 1,
     .line_m = 0.12,
     .mark_m = 0.15},
}};

// Within the allowed ranges: small 1.8..1.9 x 1.2..1.3, middle 2.4..2.6 x 1.5..1.9, large 2.6..3.1 x 1.8..2.
constexpr std::array<Goal, 3> goals{{{.width_m = 1.8, .height_m = 1.2, .depth_m = 0.6, .post_m = 0.1},
                                     {.width_m = 2.6, .height_m = 1.8, .depth_m = 0.8, .post_m = 0.1},
                                     {.width_m = 3.0, .height_m = 2.0, .depth_m = 1.0, .post_m = 0.12}}};

constexpr std::array<Ball, 3> balls{{{.radius_m = 0.07, .mass_kg = 0.205},      // size 1
                                     {.radius_m = 0.095, .mass_kg = 0.310},     // size 3
                                     {.radius_m = 0.1125, .mass_kg = 0.430}}};  // size 5

std::string is_but(std::string_view name, double value, const std::string& but) {
  std::array<char, 64> text{};
  std::snprintf(text.data(), text.size(), " is %g, but ", value);
  return std::string(name) + text.data() + but;
}

// An area in front of the goal at -x: its lines, and their crossings with the goal line and each other.
void add_area(const Field& field, double length_m, double width_m, double side, Markings& markings) {
  constexpr double pi = std::numbers::pi;
  const double goal_x_m = -side * field.goal_line_x_m();
  const double front_x_m = -side * (field.length_m / 2 - length_m + field.line_m / 2);
  const double y_m = (width_m - field.line_m) / 2;
  const double into_rad = side > 0 ? 0 : pi;  // from the goal line into the field
  for (const double sign : {-1.0, 1.0}) {
    markings.lines.push_back({{goal_x_m, sign * y_m}, {front_x_m, sign * y_m}});
    markings.crossings.push_back({{goal_x_m, sign * y_m}, CrossingKind::tee, into_rad});
    const double to_middle_rad = std::atan2(-sign, -side);
    markings.crossings.push_back({{front_x_m, sign * y_m}, CrossingKind::corner, to_middle_rad});
  }
  markings.lines.push_back({{front_x_m, -y_m}, {front_x_m, y_m}});
}

}  // namespace

Field league_field(Division division, FieldSize size) {
  static constexpr std::array<std::string_view, 3> names{"small", "middle", "large"};
  const auto robots = static_cast<std::size_t>(division), area = static_cast<std::size_t>(size);
  if (area != robots && area + (division == Division::small ? 0 : 1) != robots) {
    throw std::invalid_argument("the " + std::string(names.at(robots)) + " division does not play on the " +
                                std::string(names.at(area)) +
                                " field: small plays on small, middle on small and middle, large on middle and large");
  }
  Field field = sizes.at(area);
  field.goal = goals.at(robots);
  return field;
}

Ball league_ball(Division division) { return balls.at(static_cast<std::size_t>(division)); }

std::string field_mistake(const Field& field) {
  struct Bounded {
    std::string_view name;
    double value, above, most;
    std::string_view sentence;
  };
  const double half_m = field.length_m / 2;
  const std::array<Bounded, 15> all{{
      {"line_m", field.line_m, 0, 0.2, "lines are 0.05 to 0.12 m wide"},
      {"length_m", field.length_m, 2, 120, "fields are 2 to 120 m long"},
      {"width_m", field.width_m, 2, field.length_m, "a field is 2 m wide or more and no wider than long"},
      {"penalty_area_length_m", field.penalty_area_length_m, 0, half_m, "a penalty area ends before the halfway line"},
      {"penalty_area_width_m", field.penalty_area_width_m, 0, field.width_m, "it lies within the field"},
      {"goal_area_length_m", field.goal_area_length_m, 0, field.penalty_area_length_m, "it lies in the penalty area"},
      {"goal_area_width_m", field.goal_area_width_m, 0, field.penalty_area_width_m, "it lies in the penalty area"},
      {"goal.width_m", field.goal.width_m, 0, field.width_m, "the goal stands on the goal line"},
      {"goal.height_m", field.goal.height_m, 0, 3, "goals are up to 3 m high"},
      {"goal.depth_m", field.goal.depth_m, 0, 3, "goals are up to 3 m deep"},
      {"goal.post_m", field.goal.post_m, 0, 0.2, "posts are 0.07 to 0.12 m thick"},
      {"penalty_mark_m", field.penalty_mark_m, 0, half_m, "the penalty mark lies before the halfway line"},
      {"circle_radius_m", field.circle_radius_m, 0, field.width_m / 2, "the circle lies within the field"},
      {"border_m", field.border_m, 0, 10, "the carpet reaches at least a little beyond the lines, and 10 m at most"},
      {"mark_m", field.mark_m, 0, 0.3, "marks are 0.1 to 0.15 m wide"},
  }};
  for (const Bounded& entry : all) {
    if (!(entry.value > entry.above && entry.value <= entry.most))  // NaN fails, too
      return is_but(entry.name, entry.value, std::string(entry.sentence));
  }
  if (!(field.corner_radius_m >= 0 && field.corner_radius_m < field.width_m / 2))
    return is_but("corner_radius_m", field.corner_radius_m, "corner arcs do not meet");
  return "";
}

Markings markings_of(const Field& field) {
  constexpr double pi = std::numbers::pi;
  const double x_m = field.goal_line_x_m(), y_m = field.touchline_y_m();
  Markings markings;
  markings.lines = {{{-x_m, -y_m}, {x_m, -y_m}},
                    {{-x_m, y_m}, {x_m, y_m}},
                    {{-x_m, -y_m}, {-x_m, y_m}},
                    {{x_m, -y_m}, {x_m, y_m}},
                    {{0, -y_m}, {0, y_m}}};
  for (const double side : {-1.0, 1.0}) {
    for (const double sign : {-1.0, 1.0})
      markings.crossings.push_back({{side * x_m, sign * y_m}, CrossingKind::corner, std::atan2(-sign, -side)});
    markings.crossings.push_back({{0, side * y_m}, CrossingKind::tee, -side * pi / 2});
  }
  markings.circle_radius_m = field.circle_radius_m - field.line_m / 2;
  for (const double sign : {-1.0, 1.0})
    markings.crossings.push_back({{0, sign * markings.circle_radius_m}, CrossingKind::cross, 0});
  markings.marks.push_back({0, 0});
  for (const double side : {1.0, -1.0}) {
    add_area(field, field.goal_area_length_m, field.goal_area_width_m, side, markings);
    add_area(field, field.penalty_area_length_m, field.penalty_area_width_m, side, markings);
    markings.marks.push_back({-side * field.penalty_mark_x_m(), 0});
    for (const double sign : {-1.0, 1.0})
      markings.posts.push_back({-side * x_m, sign * (field.goal.width_m + field.goal.post_m) / 2});
  }
  return markings;
}

}  // namespace kadans::football
