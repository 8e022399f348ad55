// What viewers cost a run on the wall clock: 100 clients of its live server, half of which never read. Stretches with
// and without them alternate within one run, so that what else the machine does meets both; what is told are the
// ticks' times of both, and the median of the ratios of neighbours. Then the page in a headless Chromium.
#include <array>
#include <chrono>
#include <csignal>
#include <cstdio>
#include <stdexcept>
#include <thread>

#include <fcntl.h>
#include <nlohmann/json.hpp>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include "bench/live/crowd.h"
#include "bench/live/tick_times.h"
#include "bench/report.h"

namespace kadans::bench {
namespace {

constexpr int rounds = 8;
constexpr std::size_t clients = 100;
constexpr std::chrono::seconds stretch{3};
constexpr std::chrono::milliseconds settle{1200};  // what is told of ticks is up to a second old

// `kadans run` with a live server; stopped with the object.
class Run {
 public:
  Run() {
    int ends[2];
    if (pipe(ends) != 0) throw std::runtime_error("no pipe");
    std::vector<std::string> texts{KADANS_PROGRAM,
                                   "run",
                                   KADANS_SOURCE_DIR "/config/tulip/robot.json",
                                   "--play",
                                   "squat{repeats=100}",
                                   "--soft",
                                   "--no-ctl",
                                   "--live=0"};
    std::vector<char*> arguments;
    for (std::string& text : texts) arguments.push_back(text.data());
    arguments.push_back(nullptr);
    posix_spawn_file_actions_t files;
    posix_spawn_file_actions_init(&files);
    posix_spawn_file_actions_addopen(&files, STDOUT_FILENO, "/dev/null", O_WRONLY, 0);
    posix_spawn_file_actions_adddup2(&files, ends[1], STDERR_FILENO);
    posix_spawn_file_actions_addclose(&files, ends[0]);
    const int failed = posix_spawn(&process_, arguments[0], &files, nullptr, arguments.data(), environ);
    posix_spawn_file_actions_destroy(&files);
    close(ends[1]);
    said_ = ends[0];
    if (failed != 0) throw std::runtime_error("cannot start " KADANS_PROGRAM);
    port_ = wait_for_port();
  }
  ~Run() {
    (void)kill(process_, SIGTERM);
    (void)waitpid(process_, nullptr, 0);
    close(said_);
  }
  Run(const Run&) = delete;
  Run& operator=(const Run&) = delete;
  std::uint16_t port() const noexcept { return port_; }

 private:
  std::uint16_t wait_for_port() const {
    std::string said;
    for (char c = 0; read(said_, &c, 1) == 1;) {
      said += c;
      const std::size_t at = said.find("live on http://127.0.0.1:");
      if (c == '\n' && at != std::string::npos) return static_cast<std::uint16_t>(std::stoul(said.substr(at + 25)));
    }
    throw std::runtime_error("kadans run ended: " + said);
  }

  pid_t process_ = -1;
  int said_ = -1;
  std::uint16_t port_ = 0;
};

struct Stretch {
  double late_p50 = 0, late_p99 = 0, late_p999 = 0, takes_p50 = 0, takes_p99 = 0;
};

template <typename Wait>
Stretch measure(std::uint16_t port, Wait&& wait) {
  const TickTimes before = tick_times(port);
  wait();
  const TickTimes after = tick_times(port);
  const Distribution late = after.late.since(before.late), takes = after.takes.since(before.takes);
  return {late.percentile_us(0.5), late.percentile_us(0.99), late.percentile_us(0.999), takes.percentile_us(0.5),
          takes.percentile_us(0.99)};
}

struct Comparison {
  std::vector<Stretch> without, with;
  std::vector<double> rows_per_s;  // of one who reads
};

Comparison compare(std::uint16_t port) {
  Comparison result;
  std::this_thread::sleep_for(settle);
  for (int round = 0; round < rounds; ++round) {
    result.without.push_back(measure(port, [] { std::this_thread::sleep_for(stretch); }));
    const Crowd crowd(port, clients);
    std::this_thread::sleep_for(settle);
    const std::uint64_t rows = crowd.rows();
    const double began = now_ns();
    result.with.push_back(measure(port, [] { std::this_thread::sleep_for(stretch + settle); }));
    result.rows_per_s.push_back(static_cast<double>(crowd.rows() - rows) / (1e-9 * (now_ns() - began)) /
                                static_cast<double>(crowd.readers()));
    if (!crowd.all_there()) throw std::runtime_error("the live server sent away a client that reads");
  }
  return result;
}

void tell(Report& report, const Comparison& c, const char* key, const char* text, double Stretch::*what) {
  std::vector<double> without, with, ratios;
  for (std::size_t i = 0; i < c.with.size(); ++i) {
    without.push_back(c.without[i].*what);
    with.push_back(c.with[i].*what);
    ratios.push_back(with.back() / without.back());
  }
  const std::string path = std::string("live.tick.") + key, words = std::string("control tick ") + text;
  report.add(path + ".alone_us", words + ", nobody looks", median(without), "us");
  report.add(path + ".crowd_us", words + ", 100 clients, 50 never read", median(with), "us");
  report.add(path + ".ratio", words + ", with to without", median(ratios), "x");
}

// {"first_view_ms": ..., ...} of the page; nothing where node, Chromium or the page are not there.
std::string page_figures() {
  const std::string command = std::string(KADANS_SOURCE_DIR "/tests/app/page_check/run.sh '") +
                              KADANS_PAGE_FOLDER "' '" + KADANS_PROGRAM "' '" KADANS_SOURCE_DIR "' first_view";
  FILE* said = popen(command.c_str(), "r");  // NOLINT(cert-env33-c): a script of this repository
  if (said == nullptr) return "";
  std::string last;
  for (std::array<char, 4096> line{}; std::fgets(line.data(), line.size(), said) != nullptr;) last = line.data();
  return pclose(said) == 0 ? last : "";
}

}  // namespace

void bench_live(Report& report) {
  {
    const Run run;
    const Comparison c = compare(run.port());
    tell(report, c, "late_p50", "late, median", &Stretch::late_p50);
    tell(report, c, "late_p99", "late, 99 %", &Stretch::late_p99);
    tell(report, c, "late_p999", "late, 99.9 %", &Stretch::late_p999);
    tell(report, c, "takes_p50", "takes, median", &Stretch::takes_p50);
    tell(report, c, "takes_p99", "takes, 99 %", &Stretch::takes_p99);
    report.add("live.crowd.rows_per_s", "rows a second for each of the 50 who read", median(c.rows_per_s), "1/s");
  }
  const std::string figures = page_figures();
  if (figures.empty()) return;
  const auto json = nlohmann::ordered_json::parse(figures);
  for (const auto& [key, figure] : json.items())
    report.add("live.page." + key, figure.at("text"), figure.at("value"), figure.at("unit"));
}

}  // namespace kadans::bench
