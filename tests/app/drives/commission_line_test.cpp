// `kadans commission` with a person at a terminal, over the true wire, and when the line is lost.
#include <poll.h>
#include <pty.h>
#include <unistd.h>

#include "app/commission/commission_person.h"
#include "commission_project.h"

namespace commission_line_test {

using namespace kadans;
using namespace kadans::program;
using namespace kadans::commission_bench;

namespace {

constexpr std::int64_t ms = 1'000'000;

// This program's standard input is a terminal, and its output is kept.
class Terminal {
 public:
  explicit Terminal(const std::filesystem::path& shown) : input_(dup(STDIN_FILENO)), output_(dup(STDOUT_FILENO)) {
    REQUIRE(openpty(&master_, &slave_, nullptr, nullptr, nullptr) == 0);
    std::fflush(stdout);
    REQUIRE(dup2(slave_, STDIN_FILENO) == STDIN_FILENO);
    std::FILE* const file = std::fopen(shown.c_str(), "w");
    REQUIRE(file != nullptr);
    REQUIRE(dup2(fileno(file), STDOUT_FILENO) == STDOUT_FILENO);
    std::fclose(file);
  }
  ~Terminal() {
    std::fflush(stdout);
    dup2(input_, STDIN_FILENO);
    dup2(output_, STDOUT_FILENO);
    for (const int one : {input_, output_, slave_}) ::close(one);
    hang_up();
  }
  Terminal(const Terminal&) = delete;
  Terminal& operator=(const Terminal&) = delete;

  // They have arrived when this returns.
  void type(const std::string& keys) const {
    REQUIRE(::write(master_, keys.data(), keys.size()) == static_cast<ssize_t>(keys.size()));
    pollfd there{STDIN_FILENO, POLLIN, 0};
    REQUIRE(poll(&there, 1, -1) == 1);
  }
  void hang_up() {
    if (master_ >= 0) ::close(master_);
    master_ = -1;
  }

 private:
  int input_, output_, master_ = -1, slave_ = -1;
};

// What a person does at the terminal: it holds a key, lets it go for a second, and holds it until all was seen; and
// types what it saw. All by the bench's clock.
class TypingPerson final : public Person {
 public:
  explicit TypingPerson(Terminal& terminal) : terminal_(terminal) {}
  VirtualBench* bench = nullptr;
  Seen* seen = nullptr;
  std::vector<std::string> heard;
  std::int64_t from_ns = 0;                                             // when it was last asked to hold
  std::int64_t held_ns = -1, torque_held_ns = -1, torque_away_ns = -1;  // last key of the first hold; last torques
  bool quits = false, hangs_up = false;

  void hear(const std::string& sentence) override {
    heard.push_back(sentence);
    there_.hear(sentence);
  }
  void ask(const Question& question) override {
    there_.ask(question);
    terminal_.type(
        "pn\x7f"
        "an\n");  // with a slip
  }
  void ask_to_hold(const Question& question) override {
    heard.push_back(question.text);
    there_.ask_to_hold(question);
    from_ns = bench->now_ns();
  }
  std::optional<std::string> answer(std::int64_t now_ns) override { return there_.answer(now_ns); }
  Hand hand(std::int64_t now_ns, bool complete) override {
    const std::int64_t passed_ns = now_ns - from_ns;
    const bool away = passed_ns > 1500 * ms && passed_ns < 3000 * ms;
    if (held_ns < 0 && away) held_ns = last_key_ns_;
    if (away && hangs_up) terminal_.hang_up();
    if (passed_ns == 2999 * ms) torque_away_ns = seen->torque_until_ns;
    if (away && torque_held_ns < 0) torque_held_ns = seen->torque_until_ns;
    if (away && quits) terminal_.type("q");
    if (!away && passed_ns % (30 * ms) == 0) {
      terminal_.type(complete ? "\n" : " ");
      last_key_ns_ = now_ns;
    }
    return there_.hand(now_ns, complete);
  }
  bool gone() override { return there_.gone(); }

 private:
  Terminal& terminal_;
  TerminalPerson there_;
  std::int64_t last_key_ns_ = 0;
};

CommissionReport typed(Project& project, TypingPerson& person) {
  person.seen = &project.all.seen;
  return commission(project.settings, person, [&](const Robot& robot) {
    auto bench = std::make_unique<VirtualBench>(robot, project.truth, project.all.seen);
    person.bench = bench.get();
    return bench;
  });
}

}  // namespace

TEST_CASE("At a terminal a joint is pushed while a key is held, and let go 150 ms after the last one") {
  Project project(boards);
  project.settings.joints = {"pan"};
  project.settings.steps = {"names"};
  const auto shown = project.folder / "shown";
  {
    Terminal terminal(shown);
    TypingPerson person(terminal);
    const CommissionReport report = typed(project, person);
    CHECK(report.problems.empty());
    CHECK(!report.ended_early);
    CHECK(person.torque_held_ns > 0);
    CHECK(person.held_ns > 0);
    // What counts as held, two ticks, and what a board takes.
    CHECK(person.torque_away_ns <= person.held_ns + 150 * ms + 5 * ms);
    CHECK(person.torque_away_ns >= person.held_ns);
    CHECK(std::ranges::find(person.heard, "drive 'pan' moves joint 'pan', seen by encoder 'pan'") !=
          person.heard.end());
  }
  check_safe(project.all.seen);
  const std::string said = read(shown);
  CHECK(has(said, "Hold the space bar. Enter: seen. q: end."));
  CHECK(has(said, "That was all. Enter: go on."));
  CHECK(has(said, "Which joint moved? [pan, tilt, none]"));
  CHECK(has(said, "pn\b \ban\n"));
}

TEST_CASE("At a terminal q ends, and so does a terminal that is gone, without torque") {
  for (const bool hangs_up : {false, true}) {
    CAPTURE(hangs_up);
    Project project(boards);
    project.settings.steps = {"names"};
    Terminal terminal(project.folder / "shown");
    TypingPerson person(terminal);
    person.quits = !hangs_up;
    person.hangs_up = hangs_up;
    CHECK(typed(project, person).ended_early);
    CHECK(project.all.seen.torque_until_ns <= person.from_ns + 1500 * ms + 155 * ms);
    CHECK(!std::filesystem::exists(project.mine.string() + ".commission"));
  }
}

TEST_CASE("When the line is lost in a push the torque ends, a sentence says so, and the next run goes on there") {
  for (const Bus& bus : {boards, servos}) {
    CAPTURE(bus.type);
    const bool is_board = std::string(bus.type) == boards.type;
    Project project(bus);
    project.settings.steps = {"names"};
    project.settings.joints = {"pan"};
    project.truth.cut_at_share = 0.03;
    const Commissioned& all = project.commissioned();
    REQUIRE(all.report.problems.size() == 1);
    CHECK_MESSAGE(has(all.report.problems[0], is_board ? "its board does not answer" : "does not answer"),
                  all.report.problems[0]);
    CHECK_MESSAGE(all.report.problems[0].find("'pan'") == all.report.problems[0].rfind("'pan'"),
                  all.report.problems[0]);
    REQUIRE(all.seen.cut_ns > 0);
    // The board's watchdog takes 10 ms, a servo's 100 ms in steps of 20.
    CHECK(all.seen.torque_until_ns - all.seen.cut_ns <= (is_board ? 12 : 122) * ms);
    check_safe(all.seen);
    CHECK(read(project.mine) == read(project.right));
    project.truth.cut_at_share = 0;
    project.all.person.heard.clear();
    project.settings.joints = {};
    project.settings.steps = {"names", "direction"};
    const Commissioned& again = project.commissioned();
    for (const std::string& one : again.report.problems) CHECK_MESSAGE(one.empty(), one);
    CHECK(again.person.was_told("drive 'pan' moves joint 'pan'"));
    CHECK(again.person.was_told("joint 'tilt': a positive effort turns it"));
    check_safe(again.seen);
  }
}

TEST_CASE("kadans commission over the true wire, in two processes, with answers from a file") {
  Project project(boards);
  const auto patient = project.folder / "config/jiwiy/patient.json";
  write(patient, R"({ "based_on": "config/jiwiy/mine.json", "name": "jiwiy", // a busy machine
  "plant": { "hm2-eth": { "watchdog_s": 1, "drives": { "tilt": { "pwm_reversed": false } } } } })");
  write(project.folder / "answers",
        "# names\nhold\npan\nhold\ntilt\n# direction; tilt leaves its stop\nhold\nyes\nhold\nno\n");
  Running plant(project.folder, "plant config/jiwiy/mine.json --as hm2-eth --listen 127.0.7.121 --soft");
  REQUIRE(plant.says("serves 'jiwiy'"));
  const std::string command = "commission " + patient.string() + " --peer 127.0.7.121 --steps names,direction";
  const Outcome outcome = run(command + " --answers answers", project.folder);
  CHECK_MESSAGE(outcome.exit_code == 0, outcome.out, outcome.err);
  for (const char* part :
       {"== names\n",
        "Drive 'pan' (pwm 0, enable 20, encoder 0) wiggles while a key is held: look which joint moves\n"
        "> hold\nWhich joint moved? [pan, tilt, none]\n> pan\n",
        "drive 'tilt' moves joint 'tilt', seen by encoder 'tilt'\n", "== direction\n",
        "the sign of the motor of 'tilt' is wrong: \"pwm_reversed\": true corrects it\n", "All is done.\n"})
    CHECK_MESSAGE(has(outcome.out, part), outcome.out);
  CHECK(has(read(patient), R"("name": "jiwiy", // a busy machine)"));
  CHECK(has(read(patient), R"("tilt": { "pwm_reversed": true })"));
  const Outcome again = run(command, project.folder);
  CHECK(again.exit_code == 0);
  CHECK(again.out == "All is done.\n");
  CHECK(plant.end(SIGTERM) == 0);
}

}  // namespace commission_line_test
