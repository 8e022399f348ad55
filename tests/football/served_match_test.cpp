// A match that another game controller referees, and what a served match says of its places.
#include "football/program/served_match.h"

#include <deque>
#include <filesystem>
#include <string>

#include <doctest/doctest.h>

#include "football/program/played_match.h"
#include "kadans/signal/input_error.h"
#include "temporary_folder.h"

namespace served_match_test {

using namespace kadans::football;

namespace {

const std::string matches = KADANS_SOURCE_DIR "/config/matches/";

// Its packets come from elsewhere; on virtual time.
class Elsewhere final : public SimulatedMatch {
 public:
  using SimulatedMatch::SimulatedMatch;
  std::vector<std::vector<std::byte>> packets() override { return std::exchange(coming, {}); }
  void answer_referee(const RobotReturn& told) override { answers.push_back(told); }
  void say(const GameControl& control) {
    const auto packet = write_game_control(control);
    coming.emplace_back(packet.begin(), packet.end());
  }
  std::vector<std::vector<std::byte>> coming;
  std::vector<RobotReturn> answers;
};

GameControl control_of(GameState state) {
  GameControl control;
  control.players_per_team = 2;
  control.competition_type = 1;
  control.state = state;
  control.kicking_team = 1;
  control.remaining_s = 600;
  control.teams[0] = {.number = 1, .colour = TeamColour::blue, .keeper_colour = TeamColour::green, .keeper = 1};
  control.teams[1] = {.number = 2, .colour = TeamColour::red, .keeper_colour = TeamColour::orange, .keeper = 1};
  return control;
}

struct Stage {
  explicit Stage(const MatchConfig& match) {
    auto world = std::make_unique<Elsewhere>(match, 3);
    elsewhere = world.get();
    played = std::make_unique<PlayedMatch>(match, 3, std::move(world), true);
  }
  void go(double seconds) {
    const auto until_ns = elsewhere->time_ns() + static_cast<std::int64_t>(1e9 * seconds);
    while (elsewhere->time_ns() < until_ns && played->step()) (void)played->take_lines();
  }
  kadans::Vec3 robot(std::size_t number) { return elsewhere->robot(number).truth().base.position_m; }
  kadans::Vec3 ball() { return elsewhere->robot(0).truth().objects.at(elsewhere->object("ball")).pose.position_m; }

  Elsewhere* elsewhere = nullptr;
  std::unique_ptr<PlayedMatch> played;
};

}  // namespace

TEST_CASE(
    "Another game controller's packets lead a match: robots, hands and answers follow them, and nobody judges here") {
  const MatchConfig match = read_match(matches + "two_against_two.json");
  Stage stage(match);
  const kadans::Vec3 began = stage.robot(1);
  stage.elsewhere->coming.push_back({std::byte{1}, std::byte{2}});  // no packet of a game controller
  stage.go(1);
  CHECK(std::abs(stage.robot(1)[1] - began[1]) < 0.1);
  GameControl ready = control_of(GameState::ready);
  ready.secondary_s = 45;
  stage.elsewhere->say(ready);
  stage.go(5);
  CHECK(std::abs(stage.robot(1)[1] - began[1]) > 0.3);  // it walks to its place

  stage.elsewhere->world().put(stage.elsewhere->object("ball"), {1, 1, 0.1});
  GameControl set = control_of(GameState::set);
  set.teams[1].robots[1].penalty = Penalty::illegal_positioning;
  stage.elsewhere->say(set);
  stage.go(0.5);
  CHECK(std::hypot(stage.ball()[0], stage.ball()[1]) < 0.05);
  const Field field = match.field();
  CHECK(std::abs(stage.robot(3)[1]) > field.width_m / 2);
  CHECK(std::abs(stage.robot(3)[0]) == doctest::Approx(field.penalty_mark_x_m()).epsilon(0.1));
  CHECK(stage.played->result().decisions.empty());
  CHECK(stage.played->result().robots[3].penalties == 1);

  REQUIRE(stage.elsewhere->answers.size() >= 4 * 5);
  const RobotReturn& answer = stage.elsewhere->answers.at(1);
  CHECK(answer.player == 2);
  CHECK(answer.team == 1);
  CHECK(std::abs(answer.pose.y_m) < field.width_m);
  CHECK(read_robot_return(write_robot_return(stage.elsewhere->answers.back())).value);

  GameControl over = control_of(GameState::finished);
  over.teams[0].score = 2;
  over.first_half = false;
  stage.elsewhere->say(over);
  stage.go(1);
  CHECK(stage.played->result().ended == "by the rules");
  CHECK(stage.played->result().score[0] == 2);
}

TEST_CASE("A match whose world nobody drives any more is over, and says so") {
  class Left final : public SimulatedMatch {
   public:
    using SimulatedMatch::SimulatedMatch;
    bool step() override { return time_ns() < 100'000'000 && SimulatedMatch::step(); }
  };
  const MatchConfig match = read_match(matches + "striker_drill.json");
  PlayedMatch played(match, 1, std::make_unique<Left>(match, 1), false);
  while (played.step()) {
  }
  CHECK(played.result().ended == "because no robot is driven any more");
}

TEST_CASE("Where a match is served is read strictly") {
  const ServedPlaces places = ServedPlaces::of("127.0.0.1:7100", "10.0.0.1");
  CHECK(places.host == "127.0.0.1");
  CHECK(places.port == 7100);
  CHECK(places.referee == "10.0.0.1");
  for (const char* wrong : {"", ":", "7100", "127.0.0.1", "127.0.0.1:", "127.0.0.1:x", "127.0.0.1:0", "127.0.0.1:65530",
                            "127.0.0.1:71000", "127.0.0.1:7100x"})
    CHECK_THROWS_WITH_AS(ServedPlaces::of(wrong, ""), doctest::Contains("must be HOST:PORT"), kadans::InputError);
  CHECK_THROWS_WITH_AS(ServedPlaces::of("field:7100", ""), doctest::Contains("--listen: 'field' is no address"),
                       kadans::InputError);
  CHECK_THROWS_WITH_AS(ServedPlaces::of("127.0.0.1:7100", "referee.local"),
                       doctest::Contains("--referee: 'referee.local' is no address"), kadans::InputError);
}

TEST_CASE("A port that is taken is told with what it was for, and robots are written into the project alone") {
  const MatchConfig match = read_match(matches + "striker_drill.json");
  const DatagramPort taken("127.0.7.61", 7138);
  CHECK_THROWS_WITH_AS(ServedMatch(match, 1, ServedPlaces::of("127.0.7.61:7100", "")),
                       doctest::Contains("for the referee's packets, one of the 40 ports that serve takes"),
                       kadans::InputError);
  CHECK_THROWS_WITH_AS((void)write_robots(match, ServedPlaces::of("127.0.7.61:7100", ""), "/tmp/robots"),
                       doctest::Contains("is not in the project"), kadans::InputError);
  const kadans::test::TemporaryFolder own(std::filesystem::current_path());
  const std::filesystem::path fresh = own.path().filename() / "none/yet";
  const std::string commands = write_robots(match, ServedPlaces::of("127.0.7.61:7100", ""), fresh.string());
  CHECK(commands == "kadans run " + (fresh / "tulip/home_1.json").string() + " --plant udp --peer 127.0.7.61:7100\n");
}

TEST_CASE("Datagrams come as they were sent, from whom, and a place that is none is refused") {
  DatagramPort a("127.0.0.1", 0), b("127.0.0.1", 0);
  CHECK_FALSE(b.receive());
  const std::vector<std::byte> sent(3000, std::byte{7});
  CHECK(a.send("127.0.0.1", b.port(), std::span(sent).first(158)));
  const std::optional<Received> came = b.receive();
  REQUIRE(came);
  CHECK(came->from == "127.0.0.1");
  CHECK(came->bytes == std::vector<std::byte>(158, std::byte{7}));
  CHECK(a.send("127.0.0.1", b.port(), sent));
  CHECK(b.receive()->bytes.size() == 2048);
  CHECK_FALSE(a.send("nowhere", b.port(), sent));
  CHECK_THROWS_WITH_AS(DatagramPort("nowhere", 1), doctest::Contains("is no address"), kadans::InputError);
  CHECK_THROWS_WITH_AS(DatagramPort("127.0.0.1", b.port()), doctest::Contains("in use"), kadans::InputError);
}

}  // namespace served_match_test
