// `kadans push` here and `kadans receive` on the robot's computer, which the former starts over ssh.
#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <filesystem>
#include <optional>
#include <string>
#include <system_error>
#include <vector>

#include <CLI/CLI.hpp>
#include <fcntl.h>
#include <nlohmann/json.hpp>
#include <unistd.h>

#include "app/author/behavior_stage.h"
#include "app/author/file_checks.h"
#include "app/commands.h"
#include "app/terminal.h"
#include "config/json/foreign_json.h"
#include "config/json/problems.h"
#include "config/robot/project_root.h"
#include "config/robot/robot_config.h"
#include "delivery.h"
#include "kadans/signal/input_error.h"
#include "realtime/machine/child_process.h"
#include "remote/ctl/ctl_folder.h"
#include "remote_host.h"
#include "signal/input_file.h"
#include "signal/owned_descriptor.h"
#include "tested_contents.h"

namespace kadans {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

// `kadans push`: brings a robot's files to its computer.
struct PushOptions {
  std::string host;
  std::string robot;           // its configuration; "": the only one of the project
  std::string folder, socket;  // on the other computer; "": the usual ones
  bool undo = false, tested = false, check = false;
};

// `kadans receive`: what `push` starts there.
struct ReceiveOptions {
  std::string robot;  // its name
  std::string folder, socket;
  bool undo = false, check = false;
};

constexpr const char* state_folder = "/var/lib/kadans";
constexpr const char* delivered_folder = "robot";
constexpr std::uint64_t incoming_max_bytes = std::uint64_t{128} << 20U;
constexpr int answer_patience_ms = 15'000;

std::vector<std::string> words_for_there(const PushOptions& options, const std::string& robot) {
  std::vector<std::string> words{"receive", robot};
  if (!options.folder.empty()) words.insert(words.end(), {"--folder", options.folder});
  if (!options.socket.empty()) words.insert(words.end(), {"--socket", options.socket});
  if (options.undo) words.emplace_back("--undo");
  if (options.check) words.emplace_back("--check");
  return words;
}

void refuse_untested(const Delivery& delivery, const fs::path& root) {
  if (has_passed(root, delivery.hash())) return;
  refuse(delivery.robot,
         "the suite has not passed with these files: run 'kadans test' without selectors. Nothing "
         "was pushed");
}

// Throws InputError where there is no memory for them.
MemoryFile packed_files(const Delivery& delivery) {
  try {
    MemoryFile packed;
    write_delivery(delivery, "/proc/self/fd/" + std::to_string(packed.descriptor()));
    return packed;
  } catch (const InputError& error) {
    refuse("the files cannot be packed: " + error.problems().front().message);
  } catch (const std::system_error& error) {
    refuse(std::string("the files cannot be packed: ") + error.what());
  }
}

// Copies what comes in on stdin. Throws InputError when it is too much, and when the disk does not take it.
void take_in(const fs::path& file) {
  const OwnedDescriptor to(open(file.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC | O_NOFOLLOW, 0600));
  if (!to) refuse(file, std::generic_category().message(errno));
  std::vector<char> part(std::size_t{1} << 16U);
  std::uint64_t all = 0;
  for (;;) {
    const ssize_t got = read(STDIN_FILENO, part.data(), part.size());
    if (got < 0 && errno == EINTR && !interrupted()) continue;
    if (got < 0) refuse(file, "the push was cut off");
    if (got == 0) break;
    all += static_cast<std::uint64_t>(got);
    if (all > incoming_max_bytes) refuse(file, "more came in than a push may have");
    for (ssize_t done = 0; done < got;) {
      const ssize_t written = write(to.number(), part.data() + done, static_cast<std::size_t>(got - done));
      if (written < 0 && errno == EINTR && !interrupted()) continue;
      if (written < 0) refuse(file, std::generic_category().message(errno));
      done += written;
    }
  }
}

// The run that drives this robot, if there is one, and orders for it.
class RunThere {
 public:
  RunThere(const std::string& socket, const fs::path& folder) {
    try {
      link_.emplace(socket, Role::develop);
    } catch (const InputError& error) {
      why_ = error.problems().front().message;
      return;
    }
    const Json status = ask({{"verb", "status"}});
    const fs::path robot = status.value("configuration", std::string());
    const std::string inside = robot.lexically_relative(folder).generic_string();
    if (inside.empty() || inside.starts_with("..")) {
      link_.reset();
      why_ = "the run that goes on here drives " + robot.string();
      return;
    }
    for (const Json& behavior : status.value("behaviors", Json::array())) {
      if (!behavior.contains("error") && !behavior.contains("outcome")) plays_.push_back(behavior.value("name", ""));
    }
  }

  bool goes_on() const noexcept { return link_.has_value(); }
  const std::string& why_not() const noexcept { return why_; }
  // The behaviors that play read their files again. Returns why one could not, or nothing.
  std::optional<std::string> reload() {
    for (const std::string& name : plays_) {
      const Json answer = ask({{"verb", "reload"}, {"name", name}});
      if (!answer.value("ok", false)) return answer.value("error", name + ": refused");
      print_text(answer.value("text", name + ": reloaded") + "\n");
    }
    return std::nullopt;
  }

 private:
  Json ask(const Json& request) {
    link_->send(json_text(request));
    const std::optional<std::string> line = link_->receive(answer_patience_ms);
    if (!line) refuse("the run here does not answer");
    return parse_foreign_json(*line);
  }

  std::optional<CtlLink> link_;
  std::string why_;
  std::vector<std::string> plays_;
};

// Throws InputError with all mistakes, at the files' paths in their project.
void check_laid_out(const fs::path& project, const Delivery& delivery) {
  std::vector<InputProblem> problems;
  FileChecks checks((project / delivery.robot).string(), true);
  const std::string own = "behaviors/" + fs::path(delivery.robot).parent_path().filename().string() + "/";
  const auto check = [&](const std::string& path) {
    try {
      (void)checks.check({.file = project / path, .found = true});
    } catch (const InputError& error) {
      for (InputProblem problem : error.problems()) {
        const std::string inside = fs::path(problem.file).lexically_relative(project).generic_string();
        if (!inside.empty() && !inside.starts_with("..")) problem.file = inside;
        problems.push_back(std::move(problem));
      }
    }
  };
  check(delivery.robot);
  for (const InputFile& file : delivery.files) {
    if (problems.empty() && file.path.starts_with(own) && file.path.ends_with(".lua")) check(file.path);
  }
  if (!problems.empty()) throw InputError(problems);
}

bool counts_now(const std::string& path) { return path.ends_with(".lua"); }

// Brings the run here up to what lies in the folder now. Returns false when it refused; `back` then takes it back.
template <typename Back>
int bring_up(RunThere& run, const std::vector<DeliveryFolder::Change>& changes, Back back) {
  if (!run.goes_on()) {
    std::printf("counts from the next start: %s\n", run.why_not().c_str());
    return exit_passed;
  }
  std::optional<std::string> refused;
  try {
    refused = run.reload();
  } catch (const InputError&) {  // it is gone, or does not answer
    back();
    throw;
  }
  if (refused) {
    back();
    (void)run.reload();
    print_error(*refused);
    print_error("the run goes on with what it had, and the files are as they were");
    return exit_failed;
  }
  if (std::ranges::any_of(changes, [](const auto& change) { return !counts_now(change.path); }))
    std::puts("what is not a behavior counts from the next start of the run");
  return exit_passed;
}

void print_changes(const std::vector<DeliveryFolder::Change>& changes) {
  for (const DeliveryFolder::Change& change : changes)
    std::printf("  %s %s\n", change.path.c_str(), change.how.c_str());
  if (changes.empty()) std::puts("  nothing has changed");
}

int run_push(const PushOptions& options) {
  const RemoteHost host(options.host);
  const fs::path robot =
      options.robot.empty() ? only_robot(fs::current_path(), "kadans push HOST FILE") : fs::path(options.robot);
  if (options.undo) {
    const MemoryFile nothing;
    return host.run(words_for_there(options, read_robot_config(robot, {}).name), nothing.descriptor(), false);
  }
  const Delivery delivery = gather_delivery(robot);
  if (options.tested) refuse_untested(delivery, project_root(robot));
  const MemoryFile packed = packed_files(delivery);
  return host.run(words_for_there(options, delivery.name), packed.descriptor(), false);
}

int run_receive(const ReceiveOptions& options) {
  if (options.robot.empty() || options.robot.find('/') != std::string::npos || options.robot.front() == '.')
    refuse(in_quotes(options.robot) + " is no name of a robot");
  catch_interrupts();
  DeliveryFolder place(options.folder.empty() ? fs::path(state_folder) / options.robot / delivered_folder
                                              : fs::path(options.folder));
  if (options.undo) {
    const auto changes = place.changes_to(place.folder().string() + ".before");
    place.undo();
    std::printf("%s is again what it was before\n", place.folder().c_str());
    print_changes(changes);
    RunThere run(options.socket, place.folder());
    return bring_up(run, changes, [&] { place.undo(); });
  }
  take_in(place.incoming());
  const Delivery delivery = read_delivery(place.incoming());
  place.lay_out(delivery);
  check_laid_out(place.next(), delivery);
  const auto changes = place.changes_to(place.next());
  std::printf("%s: %s, %zu files, %s\n", place.folder().c_str(), delivery.name.c_str(), delivery.files.size(),
              delivery.hash().c_str());
  print_changes(changes);
  if (interrupted()) return exit_interrupted;
  if (options.check || changes.empty()) return exit_passed;  // undo takes the last change back
  RunThere run(options.socket, place.folder());
  const bool first = !fs::exists(place.folder());
  place.take_next();
  const int code = bring_up(run, changes, [&] {
    if (!first) place.take_back();
  });
  place.forget_older();
  return code;
}

}  // namespace

void add_push(CommandLine& line) {
  const auto [push, options] = line.add<PushOptions>(
      "push", "Bring a robot's configuration and behaviors to its computer, over ssh, as one change", run_push);
  push->add_option("host", options.host, "The computer, as ssh takes it: kadans@robot.local")
      ->required()
      ->type_name("HOST");
  push->add_option("robot", options.robot, "The robot's configuration (default: the only one of the project)")
      ->type_name("FILE");
  CLI::Option* undo = push->add_flag("--undo", options.undo, "Take the last push back; again: take that back");
  push->add_flag("--tested", options.tested, "Refuse files with which the whole suite (kadans test) has not passed")
      ->excludes(undo);
  push->add_flag("--check", options.check, "Check there, and say what would change, but change nothing")
      ->excludes(undo);
  push->add_option("--folder", options.folder, "Folder there (default: /var/lib/kadans/ROBOT/robot)")
      ->type_name("FOLDER");
  push->add_option("--socket", options.socket, "Folder of the sockets of the run there (default: the usual ones)")
      ->type_name("PATH");
  push->footer(
      "docs/robot_computer.md tells what happens there. Exit codes: 0 done, 1 the run there refused it, 2 a "
      "mistake in a file, or no such computer; unless 0, nothing has changed.");
}

// A hidden command, which `push` starts on the robot's computer.
void add_receive(CommandLine& line) {
  const auto [receive, options] = line.add<ReceiveOptions>("receive", "", run_receive);
  receive->group("");
  receive->add_option("robot", options.robot)->required();
  receive->add_option("--folder", options.folder);
  receive->add_option("--socket", options.socket);
  receive->add_flag("--undo", options.undo);
  receive->add_flag("--check", options.check);
}

}  // namespace kadans
