#include "match_file.h"

#include <algorithm>
#include <charconv>
#include <cstdio>
#include <map>

#include "kadans/config/input_object.h"
#include "kadans/signal/input_error.h"
#include "kadans/signal/random.h"

namespace kadans::football {
namespace {

constexpr double within_m = 0.1;      // a drill's ball is at least so far within the lines
constexpr double beside_gap_m = 1.0;  // between robots that stand beside the field
constexpr std::string_view name_letters = "abcdefghijklmnopqrstuvwxyz0123456789_";
const std::array<std::string, 3> division_names{"small", "middle", "large"};
const std::array<std::string, 2> start_names{"touchline", "field"};

const std::array<std::string, 7> begin_names{"play",      "free_kick", "indirect_free_kick", "penalty_kick", "throw_in",
                                             "goal_kick", "corner"};
constexpr std::array<Restart, 7> begin_restarts{
    Restart::none,         Restart::direct_free_kick, Restart::indirect_free_kick,
    Restart::penalty_kick, Restart::throw_in,         Restart::goal_kick,
    Restart::corner};
const std::array<std::string, 2> side_names{"home", "away"};

// A value of the command line as JSON: a number or a text.
std::string json_value(const std::string& text) {
  double ignored = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), ignored);
  return error == std::errc{} && end == text.data() + text.size() ? text : json_text(text);
}

// The text of a match file that is based on this one and says what is set. Each line but the first is one setting's.
// The keys of a match file are two deep.
struct SetText {
  std::string text;
  std::vector<std::string> settings;  // of the lines from the second on
};

SetText set_text(const std::filesystem::path& file, const std::vector<std::string>& settings) {
  std::map<std::string, std::vector<std::pair<std::string, std::string>>> objects;  // by name, each member's setting
  SetText set{"{ \"based_on\": " + json_text(std::filesystem::absolute(file).lexically_normal().string()), {}};
  const auto add = [&set](const std::string& text, const std::string& setting) {
    set.text += "\n, " + text;
    set.settings.push_back(setting);
  };
  for (const std::string& setting : settings) {
    const std::size_t sign = setting.find('='), dot = setting.substr(0, sign).find('.');
    if (sign == std::string::npos || sign == 0)
      throw InputError({.file = "--set", .message = "'" + setting + "' must be KEY=VALUE, such as network.lost=0.3"});
    const std::size_t key = dot == std::string::npos ? 0 : dot + 1;
    const std::string member = json_text(setting.substr(key, sign - key)) + ": " + json_value(setting.substr(sign + 1));
    if (dot == std::string::npos)
      add(member, setting);
    else
      objects[setting.substr(0, dot)].emplace_back(member, setting);
  }
  for (const auto& [name, members] : objects) {
    for (std::size_t i = 0; i < members.size(); ++i)
      add((i == 0 ? json_text(name) + ": { " : "") + members[i].first, members[i].second);
    set.text += " }";
  }
  set.text += " }";
  return set;
}

// A mistake in what was set, with the setting in place of a line that nobody has written. One between settings and the
// file stands in the first line.
void name_setting(InputProblem& problem, const std::string& file, const SetText& set) {
  if (problem.file != file || problem.line < 1) return;
  std::string all;
  for (const std::string& setting : set.settings) all += (all.empty() ? "--set " : " --set ") + setting;
  problem.file = problem.line == 1 ? all : "--set " + set.settings.at(static_cast<std::size_t>(problem.line) - 2);
  problem.line = problem.column = 0;
}

void read_set(const std::filesystem::path& file, const std::vector<std::string>& settings, MatchConfig& match) {
  const SetText set = set_text(file, settings);
  const std::filesystem::path name = file.parent_path() / "--set";
  try {
    read_input_text(set.text, name, [&](InputObject& f) { match_fields(f, match); });
  } catch (const InputError& error) {
    std::vector<InputProblem> problems = error.problems();
    for (InputProblem& problem : problems) name_setting(problem, name.string(), set);
    throw InputError(std::move(problems));
  }
  for (TeamSetup& team : match.teams) name_setting(team.parameters_place, name.string(), set);
}

void read_rules(InputObject& f, MatchRules& rules) {
  f.number("half_s", rules.half_s, {5, 3600, "s"}, "length of a half");
  f.number("break_s", rules.break_s, {1, 3600, "s"}, "length of the break");
  f.number("initial_s", rules.initial_s, {1, 600, "s"}, "before each half, until ready");
  f.number("ready_s", rules.kick_off_ready_s, {5, 120, "s"}, "to come to the places of a kick-off");
  f.number("set_s", rules.set_s, {1, 60, "s"}, "in set, until the whistle");
  f.number("stop_s", rules.stop_s, {1, 60, "s"}, "of a stop for a free kick");
  f.number("set_play_s", rules.set_play_s, {5, 120, "s"}, "to take a free kick");
  f.number("removal_s", rules.removal_s, {1, 600, "s"}, "of a penalty at the touchline");
  f.number("hidden_playing_s", rules.hidden_playing_s, {0, 60, "s"},
           "so long the packets hide playing after the whistle");
  std::uint64_t mercy = static_cast<std::uint64_t>(rules.mercy_difference), messages = rules.messages;
  f.whole("mercy_difference", mercy, 1, 1000, "lead that ends the match");
  f.whole("messages", messages, 0, 65'535, "messages of a team in a game");
  rules.mercy_difference = static_cast<int>(mercy);
  rules.messages = static_cast<std::uint16_t>(messages);
}

void read_senses(InputObject& f, SensesConfig& senses) {
  f.number("rate_Hz", senses.rate_Hz, {1, 50, "Hz"}, "pictures in a second");
  f.number("latency_s", senses.latency_s, {0, 0.5, "s"}, "from a picture to what it says");
  f.number("view_rad", senses.view_rad, {0.1, 6.3, "rad"}, "opening angle of the field of view");
  f.number("far_m", senses.far_m, {0.5, 30, "m"}, "the furthest that it sees");
  f.number("distance_noise", senses.distance_noise, {0, 0.5}, "standard deviation of a distance, per distance");
  f.number("bearing_noise_rad", senses.bearing_noise_rad, {0, 0.5, "rad"}, "standard deviation of a direction");
  f.number("missed", senses.missed, {0, 1}, "share of the pictures that miss a thing");
  f.number("imagined", senses.imagined, {0, 1}, "share of the pictures that show it where it is not");
  std::uint64_t seen = 1;
  f.whole("field_seen", seen, 0, 1, "0: no line, crossing or post of the field is seen");
  senses.field_seen = seen == 1;
}

void read_place(InputObject& f, Pose2& place) {
  f.number("x_m", place.x_m, {-15, 15, "m"}, "toward the goal that the team attacks", true);
  f.number("y_m", place.y_m, {-10, 10, "m"}, "to the left", true);
  f.number("rad", place.theta_rad, {-3.2, 3.2, "rad"}, "where it faces, 0: the goal that the team attacks");
}

void read_begin(InputObject& f, const Field& field, DrillStart& begin) {
  std::size_t with = 0, side = 0;
  f.choice("with", with, begin_names, "what it begins with: in play, or a free kick of some kind");
  f.choice("for", side, side_names, "who kicks");
  begin.restart = begin_restarts.at(with);
  begin.side = both_sides.at(side);
  const double ahead_m = field.length_m / 2 - within_m, left_m = field.width_m / 2 - within_m;
  f.number("ball_x_m", begin.ball.x_m, {-ahead_m, ahead_m, "m"},
           "where the ball lies, in the frame of the team that kicks");
  f.number("ball_y_m", begin.ball.y_m, {-left_m, left_m, "m"}, "to its left");
  f.number("ball_scatter_m", begin.ball_scatter_m, {0, 10, "m"}, "standard deviation of that");
  f.number("robots_scatter_m", begin.robots_scatter_m, {0, 5, "m"},
           "standard deviation of where robots stand from where they think they do");
  f.number("robots_scatter_rad", begin.robots_scatter_rad, {0, 3, "rad"}, "the same of where they face");
}

void read_team(InputObject& f, TeamSetup& team) {
  f.text("name", team.name, "what the team is called");
  if (f.path("team", team.folder, "the folder of the team, with its team.lua, from the project root", true) &&
      !f.is_file(team.folder + "/team.lua"))
    f.refuse("team", "team: the folder '" + team.folder + "' has no team.lua, a k.decisions");
  f.path("robot", team.robot, "the configuration of its robots");
  f.whole("players", team.players, 1, team_players_max, "robots of the team", true);
  f.whole("keeper", team.keeper, 0, team_players_max, "number of the keeper, 0: none");
  f.number("battery_s", team.battery_s, {0, 1e5, "s"},
           "how long a full battery lasts, up to a fifth less from robot to robot; 0: nothing tells of it");
  const bool given = f.text("parameters", team.parameters, "parameters of its decisions: \"passes=0, dives=0\"");
  if (given) team.parameters_place = f.place("parameters");
  if (team.parameters.find_first_of("{}\"") != std::string::npos)
    f.refuse("parameters", "parameters are NAME=NUMBER, with commas between them");
  f.object("places", "where robots stand when a drill begins; who does not play is left out", [&](InputObject& e) {
    for (std::size_t i = 0; i < team_players_max; ++i) {
      Pose2 place;
      if (e.object(std::to_string(i + 1), "of the robot with this number",
                   [&](InputObject& one) { read_place(one, place); }))
        team.places.at(i) = place;
    }
  });
  if (team.keeper > team.players)
    f.refuse("keeper", "keeper is number " + std::to_string(team.keeper) + ", but the team has " +
                           std::to_string(team.players) + " players");
}

std::string decisions_of(const TeamSetup& team) {
  return "\"decisions\": " +
         json_text(team.folder + "/team.lua" + (team.parameters.empty() ? "" : "{" + team.parameters + "}"));
}

std::string line_of(const std::string& text, int number) {
  std::size_t begin = 0;
  for (int line = 1; line < number && begin != std::string::npos; ++line) {
    begin = text.find('\n', begin);
    if (begin != std::string::npos) ++begin;
  }
  return begin == std::string::npos ? "" : text.substr(begin, text.find('\n', begin) - begin);
}

std::string number(double value) {
  std::array<char, 40> text{};
  std::snprintf(text.data(), text.size(), "%.12g", value);
  return text.data();
}

constexpr double apart_m = 0.6;  // robots that stand set out, with their arms
constexpr int draws_max = 100;

// In the world. It is drawn again while it is nearer than that to one of the others, or to a post.
Pose2 drill_place(const MatchConfig& match, RobotId id, std::uint64_t seed, const std::vector<Pose2>& others) {
  const double sign = id.side == Side::home ? -1 : 1;
  if (!match.begins) return world_pose(place_before(match, id), sign);
  RandomStream random(seed, "football.place of " + robot_name(id));
  Pose2 at;
  for (int draw = 0; draw < draws_max; ++draw) {
    Pose2 place = place_before(match, id);
    place.x_m += match.begins->robots_scatter_m * random.normal();
    place.y_m += match.begins->robots_scatter_m * random.normal();
    place.theta_rad = wrapped(place.theta_rad + match.begins->robots_scatter_rad * random.normal());
    at = world_pose(place, sign);
    const auto near = [&](const Pose2& other) { return distance(at.at(), other.at()) < apart_m; };
    if (std::ranges::none_of(others, near)) break;
  }
  return at;
}

// Where the robots stand, which think that they stand in place_before.
std::vector<Pose2> drill_places(const MatchConfig& match, std::uint64_t seed) {
  const Field field = match.field();
  const double post_x_m = field.goal_line_x_m(), post_y_m = (field.goal.width_m + field.goal.post_m) / 2;
  std::vector<Pose2> taken{
      {post_x_m, post_y_m, 0}, {post_x_m, -post_y_m, 0}, {-post_x_m, post_y_m, 0}, {-post_x_m, -post_y_m, 0}};
  const auto posts = static_cast<std::ptrdiff_t>(taken.size());
  for (const RobotId id : match.robots()) taken.push_back(drill_place(match, id, seed, taken));
  return {taken.begin() + posts, taken.end()};
}

std::string world_model() {
  std::string text = R"({
      "ball": { "what": "the ball, by its filter", "place": "point", "within_m": 20, "forget_s": 6, "fields": {
          "x_m_s": { "unit": "m/s", "what": "its velocity, ahead", "min": -20, "max": 20 },
          "y_m_s": { "unit": "m/s", "what": "its velocity, to the left", "min": -20, "max": 20 } } },
      "ball_seen": { "what": "the ball as single pictures show it", "place": "point", "within_m": 20, "forget_s": 6 },
      "field": { "what": "the field's centre; ahead of it the goal that the team attacks", "place": "pose", "within_m": 30,
                 "forget_s": 3, "fields": { "known": { "what": "1 when the robot knows where it is", "min": 0, "max": 1 } } },
      "game": { "what": "the game controller's words", "fields": {
          "state": { "what": "0 initial, 1 ready, 2 set, 3 playing, 4 finished", "min": 0, "max": 4 },
          "set_play": { "what": "0 none, 1 direct, 2 indirect free kick, 3 penalty kick, 4 throw-in, 5 goal kick, 6 corner", "min": 0, "max": 6 },
          "ours": { "what": "1 when the team kicks, 0 when the others do, -1 nobody", "min": -1, "max": 1 },
          "stopped": { "what": "1 while play is stopped", "min": 0, "max": 1 },
          "penalty": { "what": "its own penalty, 0 none", "min": 0, "max": 13 },
          "remaining_s": { "unit": "s", "what": "left of the half" },
          "secondary_s": { "unit": "s", "what": "left of ready, of a set play or of the break" },
          "lead": { "what": "goals ahead" } } },
      "whistle": { "what": "the referee's whistle", "forget_s": 30, "fields": { "count": { "what": "how often it was heard" } } },
      "me": { "what": "what the robot is in its team, and the field", "fields": {
          "number": { "what": "its number" }, "keeper": { "what": "the keeper's number, 0 none" }, "players": { "what": "robots of the team" },
          "length_m": { "unit": "m" , "what": "of the field" }, "width_m": { "unit": "m", "what": "of the field" },
          "goal_m": { "unit": "m", "what": "width of the goals" }, "circle_m": { "unit": "m", "what": "radius of the centre circle" },
          "mark_m": { "unit": "m", "what": "from a penalty mark to its goal line" } } },
      "battery": { "what": "the robot's battery, where something tells of it", "fields": {
          "charge": { "what": "share that is left", "min": 0, "max": 1 } } },
      "radio": { "what": "when to tell its mates something", "fields": {
          "say": { "what": "how often a message was worth its price so far" },
          "left": { "what": "messages that it may still send" } } })";
  for (std::size_t i = 1; i <= robots_told; ++i) {
    text +=
        ",\n      \"robot_" + std::to_string(i) +
        "\": { \"what\": \"a robot that it sees, the nearest first\", \"place\": \"point\", \"within_m\": 20, "
        "\"forget_s\": 1.5, \"fields\": { \"mate\": { \"what\": \"1 of its own team\", \"min\": 0, \"max\": 1 } } }";
  }
  return text + " }";
}

// Robots that differ, each for all its joints and links alike, as in config/sweeps/walk_long.json.
std::string differing(double share) {
  if (!(share > 0)) return "";
  const auto range = [&](const char* what, double middle, double down, double up) {
    return "\"" + std::string(what) + "\": { \"uniform\": [" + number(middle - share * down) + ", " +
           number(middle + share * up) + "] }";
  };
  return ",\n    \"randomise\": { " + range("link.*_ankle_roll_link.friction", 0.8, 0.4, 0.4) + ", " +
         range("control.*.kp_Nm_per_rad_scale", 1, 0.15, 0.15) + ", " +
         range("control.*.kd_Nms_per_rad_scale", 1, 0.15, 0.15) + ", " + range("joint.*.torque_scale", 1, 0.15, 0) +
         ", " + range("joint.*.coulomb_Nm", 0, 0, 1.5) + ", " + range("link.*.mass_scale", 1, 0.15, 0.15) + ", " +
         range("imu.gyro_noise_rad_s", 0.005, 0.005, 0.015) + " }";
}

std::string robot_fields(const MatchConfig& match, RobotId id, const Pose2& at) {
  const SensesConfig& senses = match.senses;
  return "\"robot\": " + json_text(match.team(id.side).robot) +
         ", \"start_pose\": \"set_out\",\n    \"set\": { \"start.x_m\": " + number(at.x_m) +
         ", \"start.y_m\": " + number(at.y_m) + ", \"start.yaw_rad\": " + number(at.theta_rad) + " }" +
         differing(match.robots_differ) + ",\n    \"supervisor\": " + supervisor_of(match, id) +
         ",\n    \"perception\": [{ \"entry\": \"ball_seen\", \"object\": \"ball\", \"rate_Hz\": " +
         number(senses.rate_Hz) + ", \"latency_s\": " + number(senses.latency_s) +
         ", \"distance_noise\": " + number(senses.distance_noise) +
         ", \"bearing_noise_rad\": " + number(senses.bearing_noise_rad) + ", \"missed\": " + number(senses.missed) +
         ", \"view_rad\": " + number(senses.view_rad) + ", \"far_m\": " + number(senses.far_m) +
         ", \"imagined\": " + number(senses.imagined) + ", \"hidden\": true }]";
}

std::string box(const std::string& name, const Point& at, double z_m, double x_m, double y_m, double height_m) {
  return ",\n    { \"kind\": \"box\", \"name\": " + json_text(name) + ", \"size_m\": [" + number(x_m) + ", " +
         number(y_m) + ", " + number(height_m) + "], \"position_m\": [" + number(at.x_m) + ", " + number(at.y_m) +
         ", " + number(z_m) + "] }";
}

// Posts and nets; a crossbar is higher than any ball of this ground.
std::string goals(const Field& field) {
  std::string text;
  const Goal& goal = field.goal;
  const double post_m = goal.post_m, y_m = (goal.width_m + post_m) / 2;
  for (const double end : {-1.0, 1.0}) {
    const std::string name = end < 0 ? "right" : "left";  // as the game controller sees it
    const double x_m = end * field.goal_line_x_m();
    text += box(name + "_post_1", {x_m, y_m}, goal.height_m / 2, post_m, post_m, goal.height_m);
    text += box(name + "_post_2", {x_m, -y_m}, goal.height_m / 2, post_m, post_m, goal.height_m);
    text += box(name + "_net", {x_m + end * goal.depth_m, 0}, 0.25, 0.05, goal.width_m, 0.5);
  }
  return text;
}

std::string pair(const Point& at) { return "[" + number(at.x_m) + ", " + number(at.y_m) + "]"; }

// What is painted on the carpet, for pictures. A mark is a cross.
std::string painted(const Field& field) {
  const Markings markings = markings_of(field);
  std::vector<Segment> lines = markings.lines;
  const double arm_m = (field.mark_m - field.line_m) / 2;
  for (const Point& mark : markings.marks) {
    lines.push_back({{mark.x_m - arm_m, mark.y_m}, {mark.x_m + arm_m, mark.y_m}});
    lines.push_back({{mark.x_m, mark.y_m - arm_m}, {mark.x_m, mark.y_m + arm_m}});
  }
  std::string text = ",\n    { \"kind\": \"markings\", \"line_m\": " + number(field.line_m) + ", \"lines\": [";
  for (std::size_t i = 0; i < lines.size(); ++i) {
    text += std::string(i == 0 ? "" : ", ") + "{ \"from_m\": " + pair(lines[i].from) +
            ", \"to_m\": " + pair(lines[i].to) + " }";
  }
  text += "],\n      \"arcs\": [{ \"center_m\": [0, 0], \"radius_m\": " + number(markings.circle_radius_m) + " }";
  const double corner_m = field.corner_radius_m - field.line_m / 2;
  for (unsigned corner = 0; corner < 4 && corner_m > 0; ++corner) {
    const double x_m = (corner == 0 || corner == 3 ? -1 : 1) * field.goal_line_x_m();
    const double y_m = (corner < 2 ? -1 : 1) * field.touchline_y_m();
    const double from_rad = corner * std::numbers::pi / 2;  // into the field
    text += ", { \"center_m\": " + pair({x_m, y_m}) + ", \"radius_m\": " + number(corner_m) +
            ", \"from_rad\": " + number(from_rad) + ", \"to_rad\": " + number(from_rad + std::numbers::pi / 2) + " }";
  }
  return text + "] }";
}

}  // namespace

std::string supervisor_of(const MatchConfig& match, RobotId id, const RobotPlaces& places) {
  const TeamSetup& team = match.team(id.side);
  std::string peers, to;
  for (unsigned number = 1; number <= team.players; ++number) {
    const RobotId mate{id.side, static_cast<std::uint8_t>(number)};
    if (!(mate == id)) peers += (peers.empty() ? "" : ", ") + json_text(robot_name(mate));
  }
  for (const std::string& place : places.to) to += (to.empty() ? "" : ", ") + json_text(place);
  std::string text =
      "{ " + decisions_of(team) + ", \"rate_Hz\": 20, \"when_lost\": \"stop\",\n    \"world\": " + world_model();
  if (!places.perception.empty()) text += ",\n    \"perception\": " + json_text(places.perception);
  if (!peers.empty())
    text += ",\n    \"messages\": { \"name\": " + json_text(robot_name(id)) + ", \"peers\": [" + peers + "]" +
            (places.listen.empty() ? "" : ", \"listen\": " + json_text(places.listen) + ", \"to\": [" + to + "]") +
            ", \"messages_per_minute\": 300, \"bytes_per_minute\": 150000 }";
  return text + " }";
}

std::string robot_name(RobotId id) { return (id.side == Side::home ? "home_" : "away_") + std::to_string(id.number); }

std::string json_text(std::string_view text) {
  std::string out = "\"";
  for (const char c : text) {
    if (c == '"' || c == '\\') out += '\\';
    out += static_cast<unsigned char>(c) < 0x20 ? ' ' : c;
  }
  return out + "\"";
}

std::vector<RobotId> MatchConfig::robots() const {
  std::vector<RobotId> all;
  for (const Side side : both_sides) {
    for (unsigned number = 1; number <= team(side).players; ++number)
      all.push_back({side, static_cast<std::uint8_t>(number)});
  }
  return all;
}

Pose2 place_before(const MatchConfig& match, RobotId id) {
  const Field field = match.field();
  if (const auto& place = match.team(id.side).places.at(id.index())) return *place;
  if (match.start_on_field && match.team(id.side).keeper == id.number) return {0.5 - field.length_m / 2, 0, 0};
  if (match.start_on_field) return {-1.2 - 0.9 * (id.number - 1), id.number % 2 == 0 ? 0.8 : 0, 0};
  const double y_m = field.width_m / 2 + 0.3, x_m = -field.length_m / 2 + 1.2 + beside_gap_m * (id.number - 1);
  return {x_m, id.side == Side::home ? -y_m : y_m, (id.side == Side::home ? 1 : -1) * std::numbers::pi / 2};
}

Pose2 world_pose(const Pose2& of_team, double sign) noexcept { return sign > 0 ? of_team : mirrored(of_team); }

void match_fields(InputObject& f, MatchConfig& match) {
  std::string schema, base;
  f.text("$schema", schema, "the schema of this file, for editors");
  f.text("based_on", base, "another match; this file says only what is different");
  f.text("name", match.name, "the match's name, which reports are called by", true);
  if (match.name.empty() || match.name.find_first_not_of(name_letters) != std::string::npos)
    f.refuse("name", "name must be small letters, digits and '_', such as two_against_two");
  f.text("doc", match.doc, "what it shows, one or two sentences");
  auto division = static_cast<std::size_t>(match.division), size = static_cast<std::size_t>(match.field_size);
  f.choice("division", division, division_names, "the robots' division: it gives ball and goals");
  f.choice("field", size, division_names, "the field's size: S, M or L");
  match.division = static_cast<Division>(division);
  match.field_size = static_cast<FieldSize>(size);
  Field field = league_field(Division::large, FieldSize::large);  // the schema's
  try {
    if (f.reading()) field = match.field();
  } catch (const std::invalid_argument& error) {
    f.refuse("field", error.what());
  }
  f.whole("seed", match.seed, 0, 9'007'199'254'740'992, "seed of all random numbers");
  f.object("rules", "times that differ from the rules of 2026", [&](InputObject& e) { read_rules(e, match.rules); });
  f.object(
      "home", "the team that defends the left goal first, and kicks off",
      [&](InputObject& e) { read_team(e, match.teams[0]); }, true);
  f.object("away", "the other team; without one the goal is empty",
           [&](InputObject& e) { read_team(e, match.teams[1]); });
  std::size_t start = match.start_on_field ? 1 : 0;
  f.choice("start", start, start_names, "where robots stand before a half: beside the field, or on it");
  match.start_on_field = start == 1;
  f.object("ends", "what ends it before the rules do", [&](InputObject& e) {
    e.whole("goals", match.goals, 1, 1000, "with so many goals");
    e.number("playing_s", match.playing_s, {1, 1e5, "s"}, "after so long in playing");
  });
  DrillStart begin = match.begins.value_or(DrillStart{});
  if (f.object("begins", "a drill: it begins in the middle of a match",
               [&](InputObject& e) { read_begin(e, field, begin); }))
    match.begins = begin;
  f.number("robots_differ", match.robots_differ, {0, 1},
           "0: all robots are as configured; 1: friction, masses, torque, gains and noise differ as in the sweeps");
  f.number("rolling_friction_m", match.rolling_friction_m, {1e-4, 0.1, "m"}, "how the grass slows the ball");
  f.object("network", "the network of each team", [&](InputObject& e) {
    e.number("delay_s", match.delay_s, {0, 10, "s"}, "the least time that a message takes");
    e.number("jitter_s", match.jitter_s, {0, 10, "s"}, "the most that it takes longer");
    e.number("lost", match.lost, {0, 1}, "share of the messages that are lost");
  });
  f.object("senses", "what a robot's camera says", [&](InputObject& e) { read_senses(e, match.senses); });
}

MatchConfig read_match(const std::filesystem::path& file, const std::vector<std::string>& settings) {
  MatchConfig match;
  match.file = file.string();
  match.teams[1].players = 0;
  if (settings.empty())
    read_input_object(file, [&](InputObject& f) { match_fields(f, match); });
  else
    read_set(file, settings, match);
  for (const Side side : both_sides) {
    TeamSetup& team = match.teams.at(index_of(side));
    if (team.name.empty()) team.name = side == Side::home ? "home" : "away";
  }
  match.rules.competition_type = static_cast<std::uint8_t>(match.division);
  match.rules.players_per_team = static_cast<unsigned>(std::max(match.teams[0].players, match.teams[1].players));
  return match;
}

Point drill_ball(const MatchConfig& match, std::uint64_t seed) {
  const DrillStart& begin = match.begins.value();
  RandomStream random(seed, "football.ball");
  const double half_m = match.field().length_m / 2 - within_m, side_m = match.field().width_m / 2 - within_m;
  const double x_m = std::clamp(begin.ball.x_m + begin.ball_scatter_m * random.normal(), -half_m, half_m);
  const double y_m = std::clamp(begin.ball.y_m + begin.ball_scatter_m * random.normal(), -side_m, side_m);
  const double sign = begin.side == Side::home ? -1 : 1;
  return {sign * x_m, sign * y_m};
}

std::string scenario_of(const MatchConfig& match, std::uint64_t seed) {
  const Field field = match.field();
  const Ball ball = league_ball(match.division);
  const std::vector<RobotId> robots = match.robots();
  const std::vector<Pose2> places = drill_places(match, seed);
  // The ball of a drill is put in its place once all are in the world: until then nobody may stand in it.
  const bool in_middle = std::ranges::any_of(places, [](const Pose2& at) { return norm(at.at()) < apart_m; });
  const double ball_x_m = match.begins && in_middle ? field.length_m / 2 + field.border_m + 1 : 0;
  std::string text = "{ \"name\": " + json_text(robot_name(robots.front())) + ", \"duration_s\": 100000,\n    " +
                     robot_fields(match, robots.front(), places.front()) +
                     ",\n  \"robot_name\": " + json_text(robot_name(robots.front())) + ", \"robots\": [";
  for (std::size_t i = 1; i < robots.size(); ++i) {
    text += std::string(i == 1 ? "" : ",") + "\n    { \"name\": " + json_text(robot_name(robots[i])) + ", " +
            robot_fields(match, robots[i], places[i]) + " }";
  }
  text += "],\n  \"network\": { \"delay_s\": " + number(match.delay_s) + ", \"jitter_s\": " + number(match.jitter_s) +
          ", \"lost\": " + number(match.lost) +
          " },\n  \"world\": [\n    { \"kind\": \"ball\", \"name\": \"ball\", \"radius_m\": " + number(ball.radius_m) +
          ", \"mass_kg\": " + number(ball.mass_kg) + ", \"rolling_friction_m\": " + number(match.rolling_friction_m) +
          ", \"restitution\": 0.6, \"position_m\": [" + number(ball_x_m) + ", 0, " + number(ball.radius_m) + "] }" +
          goals(field) + painted(field) + "]\n}\n";
  return text;
}

InputError told_of_match(const InputError& error, const MatchConfig& match, std::uint64_t seed) {
  const std::string scenario = scenario_of(match, seed);
  std::vector<InputProblem> told;
  for (InputProblem problem : error.problems()) {
    if (problem.file == match.file && problem.line > 0) {
      const std::string line = line_of(scenario, problem.line);
      problem.line = problem.column = 0;
      for (const TeamSetup& team : match.teams) {
        const InputProblem& at = team.parameters_place;
        if (team.parameters.empty() || line.find(decisions_of(team)) == std::string::npos) continue;
        problem.file = at.file, problem.line = at.line, problem.column = at.column;
        break;
      }
    }
    const auto is_known = [&](const InputProblem& other) { return other.text() == problem.text(); };
    if (std::ranges::none_of(told, is_known)) told.push_back(std::move(problem));
  }
  return InputError(std::move(told));
}

}  // namespace kadans::football
