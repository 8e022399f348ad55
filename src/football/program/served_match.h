// A match over the wire: its world is served in real time, each robot to a `kadans run --plant udp` with a supervisor
// of its own, on this machine or another one. What the robots perceive goes to their supervisors as datagrams; the
// referee's packets are the game controller's protocol, by UDP, so that another game controller can be the referee;
// what robots tell each other goes between them, and is counted here.
//
// This side stands for what is on each robot beside Kadans: the camera, and the program that listens to the game
// controller. Odometry for localisation is simulated from the truth: 2 % of the way and 2 % of each turn are missing or
// too much, because the robots' own does not come over the wire.
//
// Ports from --listen HOST:PORT on, robots by their number in the match: + n drives of robot n; + 10 + n its
// supervisor's perception; + 20 + n its messages; + 30 messages of home, + 31 of away, as they are counted; + 38 the
// referee's packets.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "datagram.h"
#include "football/game_control.h"
#include "kadans/app/served_scenario.h"
#include "kadans/signal/random.h"
#include "match_world.h"

namespace kadans::football {

struct ServedPlaces {
  std::string host = "127.0.0.1";
  std::uint16_t port = 7100;
  std::string referee{};  // the address of another game controller, at its usual port; "": this program's own

  // Reads "127.0.0.1:7100". Throws InputError.
  static ServedPlaces of(const std::string& listen, const std::string& referee);
};

class ServedMatch final : public MatchWorld {
 public:
  // Throws InputError: a team's files, a robot's, a port that is taken.
  ServedMatch(const MatchConfig& match, std::uint64_t seed, const ServedPlaces& places);

  bool await(int milliseconds) { return scenario_.await(milliseconds); }  // true: each robot is driven
  std::uint64_t lost_periods() const noexcept { return scenario_.lost_periods(); }

  bool step() override;
  std::int64_t time_ns() const override { return scenario_.time_ns(); }
  std::int64_t period_ns() const override { return scenario_.period_ns(); }
  std::uint64_t state_hash() const override { return 0; }  // the clock's runs have none
  std::vector<SaidLine> take_lines() override { return {}; }
  World& world() override { return scenario_.world(); }
  std::size_t object(std::string_view name) const override { return scenario_.object(name); }
  // ServedScenario counts robots alone; what it does not have throws.
  WorldRobot& robot(std::size_t number) override { return scenario_.robot(number); }
  const Catalog& catalog(std::size_t number) const override { return scenario_.catalog(number); }
  bool active(std::size_t) const override { return true; }
  Pose2 odometry(std::size_t number) const override { return odometry_.at(number).path; }
  void observe(std::size_t number, const Observation& observation) override;
  std::vector<Observation> take_observed(std::size_t number) override;
  std::uint64_t messages(std::size_t number) override;
  void send(Bytes packet) override;
  std::vector<std::vector<std::byte>> packets() override;
  void answer_referee(const RobotReturn& told) override;

 private:
  struct Odometry {
    Pose2 path, truth;
    bool begun = false;
    double way_scale = 1, turn_scale = 1;
  };

  void count_messages();
  void take_way(std::size_t number);

  MatchConfig match_;
  ServedPlaces places_;
  std::vector<RobotId> robots_;
  ServedScenario scenario_;
  DatagramPort out_, control_;
  std::array<std::unique_ptr<DatagramPort>, 2> heard_;  // messages of each team
  std::vector<std::uint64_t> messages_;
  std::vector<std::vector<Observation>> observed_;  // which nobody has taken yet
  std::vector<Odometry> odometry_;
  std::vector<std::string> hosts_;  // of the robots
};

// Writes tulip/home_1.json ... into a folder of the project: each robot's configuration with its supervisor. Returns
// the commands that run the robots, a line each. Throws InputError.
std::string write_robots(const MatchConfig& match, const ServedPlaces& places, const std::string& folder);

}  // namespace kadans::football
