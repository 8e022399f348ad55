// The fields, goals and balls of the RoboCup Humanoid Soccer League 2026, and what can be seen of a field.
//
// They are a table in code: the headers of the SDK have no reader of JSON with places and schema, and a file that is
// read less strictly than all others of the project would be worse than none. What a venue has in another size is
// changed in the struct, and `field_mistake` says what cannot be.
//
// Source: RoboCup-HumanoidSoccerLeague/HSL-Rules, rules/environment.tex (0540262), Law 1: "Exemplary field dimensions
// by field type" and "Allowed ranges for goal dimensions", Law 2: "Balls used in each division". The rules give no
// radius and no mass of a ball: these are those of the balls of RoboCup-Humanoid-TC/hlvs_webots (87829b1). Small
// division: FIFA mini ball, size 1.
//
// Frame: origin at the centre mark, on the ground; x along the field, y to the left of x, z up. All measures of areas
// and of the field reach to the outer edges of lines, because lines belong to what they bound.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "plane.h"

namespace kadans::football {

enum class Division : std::uint8_t { small, middle, large };   // of robots: it gives ball and goals
enum class FieldSize : std::uint8_t { small, middle, large };  // S, M and L

struct Goal {
  double width_m = 0;   // between the posts
  double height_m = 0;  // below the crossbar
  double depth_m = 0;
  double post_m = 0;  // diameter of posts and crossbar
};

struct Field {
  double length_m = 0, width_m = 0;
  Goal goal;
  double goal_area_length_m = 0, goal_area_width_m = 0;
  double penalty_area_length_m = 0, penalty_area_width_m = 0;
  double penalty_mark_m = 0;      // from the goal line
  double circle_radius_m = 0;     // of the centre circle; opponents keep this distance at free kicks, too
  double corner_radius_m = 0;     // 0: there are no corner arcs
  double border_m = 0;            // carpet around the field
  double line_m = 0, mark_m = 0;  // width of lines, size of the marks

  // Centre lines of the painted lines.
  double goal_line_x_m() const noexcept { return (length_m - line_m) / 2; }
  double touchline_y_m() const noexcept { return (width_m - line_m) / 2; }
  double penalty_mark_x_m() const noexcept { return length_m / 2 - penalty_mark_m; }
};

struct Ball {
  double radius_m = 0;
  double mass_kg = 0;
};

// Throws std::invalid_argument where a division does not play on a field: small S, middle S and M, large M and L.
Field league_field(Division division, FieldSize size);
Ball league_ball(Division division);

// What cannot be in a field: "goal_area_width_m is 7, but the penalty area is 6 wide". "": nothing.
std::string field_mistake(const Field& field);

struct Segment {
  Point from, to;
};

enum class CrossingKind : std::uint8_t { corner, tee, cross };  // L, T and X

// `mouth_rad`: where its open side points. Of an L between its two arms, of a T along its stem; an X has none (0).
struct Crossing {
  Point at;
  CrossingKind kind = CrossingKind::corner;
  double mouth_rad = 0;
};

// What is seen of a field from above; lines are their centre lines.
struct Markings {
  std::vector<Segment> lines;
  std::vector<Crossing> crossings;
  std::vector<Point> marks;    // centre, then the penalty marks
  std::vector<Point> posts;    // their centres
  double circle_radius_m = 0;  // of the centre circle's centre line
};

Markings markings_of(const Field& field);

}  // namespace kadans::football
