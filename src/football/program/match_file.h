// A match in one JSON file: two teams by their folders, field, times, what robots perceive and how they hear each other
// (docs/football.md). And the scenario of several robots that it is played in.
//
// A team is a folder with a `team.lua`, a k.decisions. All it knows comes by the world model, whose entries are those
// that docs/football.md lists; all it does it does by playing behaviors and by messages.
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "football/field.h"
#include "football/match.h"
#include "kadans/signal/input_error.h"

namespace kadans {
class InputObject;
}

namespace kadans::football {

inline constexpr unsigned team_players_max = 4;  // of the robots that one world holds, eight
inline constexpr std::size_t robots_told = 3;    // of those that a robot sees: the nearest ones

struct TeamSetup {
  std::string name, folder, robot = "config/tulip/robot.json";
  std::string parameters;                                     // of its decisions: "passes=0, dives=0"
  InputProblem parameters_place;                              // where they stand
  std::uint64_t players = 1, keeper = 0;                      // keeper 0: there is none
  double battery_s = 0;                                       // that a full battery lasts; 0: nothing tells of it
  std::array<std::optional<Pose2>, team_players_max> places;  // of a drill, in the team's frame
};

// What a drill begins with: in play, or with a free kick or penalty kick. All is scattered by the seed.
struct DrillStart {
  Restart restart = Restart::none;  // none: in play
  Side side = Side::home;           // who kicks
  Point ball;                       // in the frame of that team
  double ball_scatter_m = 0;
  double robots_scatter_m = 0, robots_scatter_rad = 0;  // of what the robots know of their places, standard deviations
};

// What a robot's camera says of the ball, of other robots and of the field.
struct SensesConfig {
  double rate_Hz = 15, latency_s = 0.06;
  double view_rad = 2, far_m = 6;  // about straight ahead
  double distance_noise = 0.04, bearing_noise_rad = 0.02;
  double missed = 0.2, imagined = 0.02;  // shares of the pictures
  bool field_seen = true;                // lines, crossings, posts: without, a robot counts its way alone
};

struct MatchConfig {
  std::string file, name, doc;
  Division division = Division::middle;
  FieldSize field_size = FieldSize::small;
  MatchRules rules;
  std::array<TeamSetup, 2> teams;
  std::uint64_t seed = 1;
  bool start_on_field = false;       // else at the touchline of their own half
  std::optional<DrillStart> begins;  // else with the first half
  double robots_differ = 0;          // share of the ranges that the sweeps of walking draw robots from
  std::uint64_t goals = 0;           // it ends with so many; 0: the rules end it
  double playing_s = 0;              // it ends after so long in playing; 0: the rules end it
  double rolling_friction_m = 0.004;
  double delay_s = 0.01, jitter_s = 0.01, lost = 0.05;  // of messages
  SensesConfig senses;

  const TeamSetup& team(Side side) const noexcept { return teams.at(index_of(side)); }
  Field field() const { return league_field(division, field_size); }
  std::vector<RobotId> robots() const;  // in the order of the scenario
};

// Throws InputError with all mistakes. `settings` stand in place of what the file says: "network.lost=0.3".
MatchConfig read_match(const std::filesystem::path& file, const std::vector<std::string>& settings = {});
void match_fields(InputObject& f, MatchConfig& match);  // for the reader, and for the schema

// Where a robot stands before a half, in its team's frame: at the touchline, or on the field. Before the kick-off the
// teams walk from there to their places.
Pose2 place_before(const MatchConfig& match, RobotId id);
Pose2 world_pose(const Pose2& of_team, double sign) noexcept;  // Match::sign of the team

// Where a robot's supervisor listens and sends in a match over the wire, "host:port"; in a simulation nowhere.
struct RobotPlaces {
  std::string perception, listen;
  std::vector<std::string> to;
};
// The text of a robot's `supervisor`.
std::string supervisor_of(const MatchConfig& match, RobotId id, const RobotPlaces& places = {});

std::string robot_name(RobotId id);            // "home_1"
std::string json_text(std::string_view text);  // in JSON's quotes
// The text of the scenario, for kadans::Simulation. The seed scatters what a drill begins with.
std::string scenario_of(const MatchConfig& match, std::uint64_t seed);
// What is wrong with that scenario, with places of the match file: a mistake in a team's parameters has theirs, and
// what else the match made has none.
InputError told_of_match(const InputError& error, const MatchConfig& match, std::uint64_t seed);
// Where the ball lies when the drill of `match.begins` begins, in the world's frame.
Point drill_ball(const MatchConfig& match, std::uint64_t seed);

}  // namespace kadans::football
