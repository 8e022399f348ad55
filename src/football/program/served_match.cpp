#include "served_match.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdio>

#include "kadans/signal/input_error.h"
#include "kadans/signal/output_file.h"

namespace kadans::football {
namespace {

constexpr std::uint16_t perception_from = 10, messages_from = 20, counted_from = 30, control_at = 38, ports_taken = 40;
constexpr double odometry_sd = 0.02;
constexpr double lifted_m = 0.1, lifted_rad = 0.5;  // in a period: a person moved it
// A world on a machine that is busy pauses now and then: its samples are late, and the robot waits for them.
constexpr const char* patience =
    ",\n  \"safety\": { \"silent_ticks_max\": 50 },\n  \"plant\": { \"udp\": { \"round_trip_max_s\": 0.05, "
    "\"connect_timeout_s\": 60 } }";
constexpr std::string_view from_key = "\"from\":\"";

std::vector<std::string> plant_places(const MatchConfig& match, const ServedPlaces& places) {
  std::vector<std::string> all;
  for (std::size_t i = 0; i < match.robots().size(); ++i)
    all.push_back(places.host + ":" + std::to_string(places.port + i));
  return all;
}

// As docs/supervisor.md has it.
std::string datagram_of(const SeenInfo& entry, const Observation& seen, std::int64_t now_ns) {
  std::array<char, 48> text{};
  const auto put = [&](const std::string& name, double value) {
    std::snprintf(text.data(), text.size(), "%.9g", value);
    return ", " + json_text(name) + ": " + text.data();
  };
  std::string line = "{\"kadans\": 1, \"seen\": [{\"entry\": " + json_text(entry.name) +
                     put("age_s", std::max(0.0, 1e-9 * static_cast<double>(now_ns - seen.time_ns))) +
                     put("confidence", seen.confidence);
  for (std::size_t i = 0; i < entry.fields.size(); ++i) line += put(entry.fields[i].name, seen.fields.at(i));
  return line + "}]}";
}

Bytes text_bytes(const std::string& text) { return std::as_bytes(std::span(text.data(), text.size())); }

std::uint16_t port_of(const ServedPlaces& places, std::uint16_t from, std::size_t number) {
  return static_cast<std::uint16_t>(places.port + from + number);
}

DatagramPort opened(const std::string& host, std::uint16_t port, const char* what) {
  try {
    return DatagramPort(host, port);
  } catch (const InputError& error) {
    throw InputError({.file = error.problems().front().file,
                      .message = error.problems().front().message + ": for " + what + ", one of the " +
                                 std::to_string(ports_taken) + " ports that serve takes"});
  }
}

}  // namespace

ServedPlaces ServedPlaces::of(const std::string& listen, const std::string& referee) {
  const std::size_t colon = listen.rfind(':');
  ServedPlaces places{.host = listen.substr(0, colon), .referee = referee};
  std::uint16_t port = 0;
  const char* const end = listen.data() + listen.size();
  const auto [rest, error] = std::from_chars(listen.data() + std::min(colon, listen.size() - 1) + 1, end, port);
  if (colon == std::string::npos || error != std::errc{} || rest != end || port == 0 || port > 65'535 - ports_taken)
    throw InputError({.file = "--listen",
                      .message = "'" + listen + "' must be HOST:PORT, such as 127.0.0.1:7100: " +
                                 std::to_string(ports_taken) + " ports from there on are taken"});
  places.port = port;
  const auto check = [](const char* option, const std::string& host) {
    if (!is_address(host))
      throw InputError({.file = option, .message = "'" + host + "' is no address of IPv4, such as 127.0.0.1"});
  };
  check("--listen", places.host);
  if (!referee.empty()) check("--referee", referee);
  return places;
}

ServedMatch::ServedMatch(const MatchConfig& match, std::uint64_t seed, const ServedPlaces& places)
    : match_(match),
      places_(places),
      robots_(match.robots()),
      scenario_(scenario_of(match, seed), match.file, seed, plant_places(match, places)),
      out_("0.0.0.0", 0),
      control_(places.referee.empty() ? opened(places.host, port_of(places, control_at, 0), "the referee's packets")
                                      : DatagramPort("0.0.0.0", control_port)),
      messages_(robots_.size()),
      observed_(robots_.size()),
      odometry_(robots_.size()),
      hosts_(robots_.size()) {
  for (std::size_t side = 0; side < heard_.size(); ++side)
    heard_.at(side).reset(
        new DatagramPort(opened(places.host, port_of(places, counted_from, side), "the messages of a team")));
  for (std::size_t i = 0; i < robots_.size(); ++i) {
    RandomStream random(seed, "football.odometry of " + robot_name(robots_[i]));
    odometry_[i].way_scale += odometry_sd * random.normal();
    odometry_[i].turn_scale += odometry_sd * random.normal();
  }
}

// The way since the last period, as the robot feels it.
void ServedMatch::take_way(std::size_t number) {
  Odometry& odometry = odometry_[number];
  const Pose2 now = ground_pose(scenario_.robot(number).truth().base);
  const Point way = in_frame(odometry.truth, now.at());
  const double turn_rad = wrapped(now.theta_rad - odometry.truth.theta_rad);
  const bool lifted = !odometry.begun || norm(way) > lifted_m || std::abs(turn_rad) > lifted_rad;
  odometry.begun = true;
  odometry.truth = now;
  if (lifted) return;
  const Point step = turned(odometry.way_scale * way, odometry.path.theta_rad);
  odometry.path.x_m += step.x_m;
  odometry.path.y_m += step.y_m;
  odometry.path.theta_rad = wrapped(odometry.path.theta_rad + odometry.turn_scale * turn_rad);
}

bool ServedMatch::step() {
  if (!scenario_.step()) return false;
  for (std::size_t i = 0; i < robots_.size(); ++i) {
    take_way(i);
    for (const Observation& seen : scenario_.take_observed(i)) {
      observe(i, seen);
      observed_[i].push_back(seen);
    }
  }
  return true;
}

std::vector<Observation> ServedMatch::take_observed(std::size_t number) {
  return std::exchange(observed_.at(number), {});
}

void ServedMatch::observe(std::size_t number, const Observation& observation) {
  if (hosts_.at(number).empty()) {
    const std::string peer = scenario_.peer(number);
    hosts_[number] = peer.substr(0, peer.rfind(':'));
  }
  const SeenInfo& entry = scenario_.catalog(number).seen.at(observation.entry);
  (void)out_.send(hosts_[number], port_of(places_, perception_from, number),
                  text_bytes(datagram_of(entry, observation, time_ns())));
}

void ServedMatch::count_messages() {
  for (const auto& port : heard_) {
    while (const std::optional<Received> came = port->receive()) {
      const std::string_view text(reinterpret_cast<const char*>(came->bytes.data()), came->bytes.size());
      const std::size_t at = text.find(from_key);
      if (at == std::string_view::npos) continue;
      const std::string_view rest = text.substr(at + from_key.size());
      for (std::size_t i = 0; i < robots_.size(); ++i) {
        if (rest.starts_with(robot_name(robots_[i]) + "\"")) ++messages_[i];
      }
    }
  }
}

std::uint64_t ServedMatch::messages(std::size_t number) {
  if (number == 0) count_messages();
  return messages_.at(number);
}

void ServedMatch::send(Bytes packet) { (void)out_.send(places_.host, control_.port(), packet); }

std::vector<std::vector<std::byte>> ServedMatch::packets() {
  std::vector<std::vector<std::byte>> all;
  while (std::optional<Received> came = control_.receive()) {
    if (places_.referee.empty() || came->from == places_.referee) all.push_back(std::move(came->bytes));
  }
  return all;
}

void ServedMatch::answer_referee(const RobotReturn& told) {
  if (!places_.referee.empty()) (void)out_.send(places_.referee, return_port, write_robot_return(told));
}

std::string write_robots(const MatchConfig& match, const ServedPlaces& places, const std::string& folder) {
  namespace fs = std::filesystem;
  const fs::path here = fs::current_path(), inside = fs::weakly_canonical(here / folder).lexically_relative(here);
  if (inside.empty() || inside.begin()->string() == "..")
    throw InputError({.file = "--robots",
                      .message = "'" + folder + "' is not in the project " + here.string() +
                                 ": the robots' configurations are based on others of it"});
  const std::vector<RobotId> robots = match.robots();
  const auto place = [&](std::uint16_t port) { return places.host + ":" + std::to_string(port); };
  std::string commands;
  for (std::size_t i = 0; i < robots.size(); ++i) {
    RobotPlaces own{.perception = ":" + std::to_string(port_of(places, perception_from, i)),
                    .listen = ":" + std::to_string(port_of(places, messages_from, i)),
                    .to = {place(port_of(places, counted_from, index_of(robots[i].side)))}};
    for (std::size_t j = 0; j < robots.size(); ++j) {
      if (j != i && robots[j].side == robots[i].side) own.to.push_back(place(port_of(places, messages_from, j)));
    }
    // A robot's behaviors are those of the folder that its configuration stands in.
    const std::filesystem::path robot = match.team(robots[i].side).robot;
    const std::string file =
        (std::filesystem::path(folder) / robot.parent_path().filename() / (robot_name(robots[i]) + ".json"))
            .generic_string();
    write_output_file(file, "{\n  \"based_on\": " + json_text(robot.generic_string()) + patience +
                                ",\n  \"supervisor\": " + supervisor_of(match, robots[i], own) + "\n}\n");
    commands += "kadans run " + file + " --plant udp --peer " + place(port_of(places, 0, i)) + "\n";
  }
  return commands;
}

}  // namespace kadans::football
