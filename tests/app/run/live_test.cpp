// `kadans run`, jitter and doctor as a person would call them; the runs on virtual time.
#include <csignal>
#include <cstdlib>
#include <filesystem>

#include <doctest/doctest.h>
#include <netinet/in.h>
#include <nlohmann/json.hpp>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

#include "app/program.h"

namespace live_test {

using namespace kadans::program;
using Json = nlohmann::json;

namespace {

Json result_of(const std::string& out) { return Json::parse(out); }

}  // namespace

TEST_CASE("run squats on threads, records every tick, and ends with the robot off") {
  const auto project = project_copy("live_squat");
  const Outcome outcome =
      run("run config/tulip/robot.json --play squat --duration 3 --threads-on-virtual-time --record live.mcap --json",
          project);
  CHECK_MESSAGE(outcome.exit_code == 0, outcome.err);
  const Json result = result_of(outcome.out);
  CHECK(result["passed"] == true);
  CHECK(result["ended"] == "duration over");
  CHECK(result["commands"]["sent"] > 0);
  CHECK(result["commands"]["sent"] == result["commands"]["applied"]);
  CHECK(result["commands"]["refused"] == 0);
  CHECK(result["threads"]["control"]["missed"] == 0);
  CHECK(result["record"]["rows"] == result["control_ticks"]);
  CHECK(result["record"]["dropped"] == 0);
  CHECK(result["safety_level"] == "off");
  CHECK(std::filesystem::file_size(project / "live.mcap") > 100'000);
}

TEST_CASE("run binds all functions of its libraries before main(): no thread looks one up when it first calls it") {
  const auto project = project_copy("live_bound");
  // The dynamic linker's own account, of the behaviors' process too.
  write(project / "bound.sh",
        "LD_DEBUG=bindings,files LD_DEBUG_OUTPUT=bound \"$1\" run config/tulip/robot.json --play squat --duration 1"
        " --behaviors process --threads-on-virtual-time >out 2>&1\n");
  const std::string program = (std::filesystem::path(KADANS_BINARY_DIR) / "kadans").string();
  REQUIRE(std::system(("cd '" + project.string() + "' && sh bound.sh '" + program + "'").c_str()) == 0);
  int processes = 0;
  for (const auto& entry : std::filesystem::directory_iterator(project)) {
    if (!entry.path().filename().string().starts_with("bound.") || entry.path().extension() == ".sh") continue;
    const std::string account = read(entry.path());
    const std::size_t main_begins = account.rfind("transferring control");
    REQUIRE(main_begins != std::string::npos);
    const std::size_t late = account.find("binding file", main_begins);
    CHECK_MESSAGE(late == std::string::npos, account.substr(late, 200));
    ++processes;
  }
  CHECK(processes == 2);
}

#ifndef KADANS_SANITIZED  // they take memory of their own
TEST_CASE("run holds at most 40 MB with its flight recorder, and 64 MB with the page") {
  const auto project = project_copy("live_memory");
  write(project / "memory.sh",
        "\"$@\" >out 2>err & sleep 3; awk '/^VmRSS/ {print $2}' /proc/$!/status >kB; wait $!; true\n");
  const std::string program = (std::filesystem::path(KADANS_BINARY_DIR) / "kadans").string();
  const int bare_MB = __GLIBC_MINOR__ < 41 ? 40 : 42;  // Debian 13's libraries are larger
  for (const bool page : {false, true}) {
    CAPTURE(page);
    const std::string command =
        "'" + program + "' run config/tulip/robot.json --play squat --soft --duration 4" + (page ? " --live=0" : "");
    REQUIRE(std::system(("cd '" + project.string() + "' && sh memory.sh " + command).c_str()) == 0);
    const std::string kB = read(project / "kB");
    REQUIRE(!kB.empty());
    CHECK(std::stoi(kB) > 0);
    CHECK(std::stoi(kB) <= 1024 * (page ? 64 : bare_MB));
  }
}
#endif

TEST_CASE(
    "run ends cleanly on SIGTERM and when its terminal closes: behaviors leave, the robot is off, the record closed") {
  for (const std::string signal : {"TERM", "HUP"}) {
    CAPTURE(signal);
    const auto project = project_copy("live_term");
    // Waits for the first transition, then sends the signal.
    write(project / "term.sh",
          "mkfifo told\n"
          "env --default-signal=HUP $1 run config/tulip/robot.json --plant ideal --play squat "
          "--threads-on-virtual-time -v"
          " --record r.mcap --json >out 2>told &\n"
          "exec 3<told; read -r line <&3; kill -$2 $!; cat <&3 >err; wait $!\n");
    const std::string program = (std::filesystem::path(KADANS_BINARY_DIR) / "kadans").string();
    const int status = std::system(("cd '" + project.string() + "' && sh term.sh '" + program + "' " + signal).c_str());
    CHECK(status == 0);
    const Json result = result_of(read(project / "out"));
    CHECK(result["ended"] == "told to stop");
    CHECK(result["safety_level"] == "off");
    CHECK(result["record"]["rows"] == result["control_ticks"]);
    CHECK(has(read(project / "err"), "supervisor: stop"));
  }
}

TEST_CASE("run goes on when nobody reads any more what it says, and ends with its record closed") {
  const auto project = project_copy("live_unread");
  write(project / "unread.sh",
        "{ $1 run config/tulip/robot.json --plant ideal --play squat --threads-on-virtual-time -v --record r.mcap"
        " --duration 4; echo $? >code; } 2>&1 | head -1 >first\n");
  const std::string program = (std::filesystem::path(KADANS_BINARY_DIR) / "kadans").string();
  REQUIRE(std::system(("cd '" + project.string() + "' && sh unread.sh '" + program + "'").c_str()) == 0);
  CHECK(read(project / "code") == "0\n");  // a reader that has had enough is no error
  const Outcome info = run("log info r.mcap", project);
  CHECK(info.exit_code == 0);
  CHECK_FALSE(has(info.out, "CUT SHORT"));
}

TEST_CASE("run is led by a joystick's recording, also when behaviors play in a process of their own") {
  const auto project = project_copy("live_joystick");
  for (const std::string behaviors : {"thread", "process"}) {
    CAPTURE(behaviors);
    const Outcome outcome =
        run("run config/jiwiy/robot.json --plant ideal --play stick --joystick config/joystick/jiwiy_round.evemu"
            " --duration 2 --threads-on-virtual-time --verbose --behaviors " +
                behaviors,
            project);
    CHECK_MESSAGE(outcome.exit_code == 0, outcome.err);
    CHECK(has(outcome.err, "joystick: is there"));
    CHECK(has(outcome.err, "velocity -> effort (button 3)"));
  }
}

TEST_CASE("run refuses a joystick that is not there before anything moves") {
  const Outcome outcome = run("run config/jiwiy/robot.json --joystick /dev/input/none --threads-on-virtual-time",
                              project_copy("live_no_joystick"));
  CHECK(outcome.exit_code == 2);
  CHECK(has(outcome.err, "/dev/input/none: there is no such device"));
}

TEST_CASE("run refuses a wrong list before anything moves") {
  const auto project = project_copy("live_wrong");
  const Outcome outcome =
      run("run config/tulip/robot.json --play sqat --duration 1 --threads-on-virtual-time", project);
  CHECK(outcome.exit_code == 2);
  CHECK(has(outcome.err, "did you mean 'squat'"));
}

TEST_CASE("run and plant say what is wrong with a network before anything moves") {
  const auto project = project_copy("live_network");
  const std::string udp = "run config/tulip/robot.json --plant udp --soft";
  const Outcome nobody = run(udp, project);
  CHECK(nobody.exit_code == 2);
  CHECK(has(nobody.err, "says no plant.udp.peer: name the machine that serves the plant with --peer HOST:PORT"));
  const Outcome nowhere = run(udp + " --peer nowhere", project);
  CHECK(nowhere.exit_code == 2);
  CHECK(has(nowhere.err, "'nowhere' must be HOST:PORT"));
  CHECK(run(udp + " --peer 127.0.0.1:7 --threads-on-virtual-time", project).exit_code == 2);
  const Outcome plant = run("plant config/tulip/robot.json --listen 127.0.0.1:77777 --soft", project);
  CHECK(plant.exit_code == 2);
  CHECK(has(plant.err, "must be HOST:PORT"));
}

TEST_CASE("run that waits for a plant on the network ends on SIGINT") {
  const auto project = project_copy("live_waiting");
  const int plant = socket(AF_INET, SOCK_DGRAM, 0);
  sockaddr_in place{};
  place.sin_family = AF_INET;
  place.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  socklen_t size = sizeof place;
  REQUIRE(bind(plant, reinterpret_cast<sockaddr*>(&place), size) == 0);
  REQUIRE(getsockname(plant, reinterpret_cast<sockaddr*>(&place), &size) == 0);
  const timeval patience{.tv_sec = 30, .tv_usec = 0};
  setsockopt(plant, SOL_SOCKET, SO_RCVTIMEO, &patience, sizeof patience);
  const pid_t child = fork();
  if (child == 0) {
    const std::string peer = "127.0.0.1:" + std::to_string(ntohs(place.sin_port));
    if (chdir(project.c_str()) != 0) _exit(100);
    execl(KADANS_BINARY_DIR "/kadans", "kadans", "run", "config/tulip/robot.json", "--plant", "udp", "--peer",
          peer.c_str(), "--soft", "--no-ctl", nullptr);
    _exit(101);
  }
  char greeting = 0;
  CHECK(recv(plant, &greeting, 1, 0) == 1);  // it waits for the answer
  kill(child, SIGINT);
  int status = 0;
  CHECK(waitpid(child, &status, 0) == child);
  CHECK(WIFEXITED(status));
  CHECK(WEXITSTATUS(status) == 130);
  close(plant);
}

TEST_CASE("doctor tells of any machine whose files it is given") {
  const auto folder = fresh_folder("doctor");
  std::filesystem::create_directories(folder / "machine/sys/kernel");
  write(folder / "machine/sys/kernel/realtime", "1\n");
  const Outcome outcome = run("doctor --root machine --json", folder);
  CHECK(outcome.exit_code == 1);
  const Json result = Json::parse(outcome.out);
  CHECK(result["good"] == false);
  CHECK(result["findings"][0]["topic"] == "kernel");
  CHECK(result["findings"][0]["good"] == true);
  CHECK(has(run("doctor --root machine", folder).out, "to change it"));
}

TEST_CASE("jitter tells its figures in words, or as one object and nothing else, and draws them") {
  const auto folder = fresh_folder("jitter");
  const Outcome outcome = run("jitter --seconds 0.1 --no-keep-awake --json --svg jitter.svg", folder);
  CHECK(outcome.exit_code == 0);
  CHECK(has(run("jitter --seconds 0.1 --no-keep-awake", folder).out, "verdict:"));
  const Json result = Json::parse(outcome.out);
  CHECK(result["samples"] == 100);
  for (const char* what : {"lateness_us", "jitter_us", "execution_us"}) {
    for (const char* which : {"p50", "p99", "p999", "max"}) CHECK(result[what][which].is_number());
  }
  CHECK(result["overruns"].is_number());
  CHECK(has(read(folder / "jitter.svg"), "</svg>"));
}

}  // namespace live_test
