// A behavior to measure: ten states in a ring, and a `during` that reads 14 joints.
#pragma once

#include <filesystem>
#include <fstream>
#include <memory>
#include <string>

#include <unistd.h>

#include "script/behavior/behavior.h"

namespace kadans::bench {

class TransitionCount final : public LineSink {
 public:
  void tell(const Line& line) override {
    transitions += line.transition != nullptr ? 1 : 0;
    if (line.transition == nullptr) last = line.text;
  }
  std::uint64_t transitions = 0;
  std::string last;
};

// `during` reads 14 joints or does nothing; every state is left after so long, or as `by` says.
inline std::string ring(double after_s, bool reads, const std::string& by = "") {
  std::string text = "local k = require 'kadans'\nlocal total = 0\n";
  text += "local function look(m, s)\n  local j, sum = s.joints, 0\n";
  for (int i = 0; i < 14; ++i) text += "  sum = sum + j.joint_" + std::to_string(i) + ".position_rad\n";
  text += "  total = sum\nend\nreturn k.behavior 'ring' { initial = 's0', " +
          std::string(reads ? "during = look,\n" : "\n");
  for (int i = 0; i < 10; ++i) {
    text += "k.state 's" + std::to_string(i) + "' { { " + (by.empty() ? "after = " + std::to_string(after_s) : by) +
            ", to = 's" + std::to_string((i + 1) % 10) + "' } },\n";
  }
  return text + "}\n";
}

struct Played {
  explicit Played(const std::string& text)
      : folder(std::filesystem::temp_directory_path() / ("kadans_chart_" + std::to_string(getpid()))) {
    std::filesystem::create_directories(folder);
    std::ofstream(folder / "ring.lua") << text;
    for (int i = 0; i < 14; ++i) model.joints.push_back({.name = "joint_" + std::to_string(i)});
    catalog.model = &model;
    behavior =
        std::make_unique<Behavior>(Behavior::Settings{.root = folder, .file = folder / "ring.lua"}, catalog, log);
  }
  ~Played() {
    std::error_code ignored;
    std::filesystem::remove_all(folder, ignored);
  }
  Played(const Played&) = delete;
  Played& operator=(const Played&) = delete;
  void prepare() { behavior->prepare(snapshot); }
  void tick() {
    (void)behavior->tick(snapshot, sender);
    snapshot.time_ns += 10'000'000;
  }

  std::filesystem::path folder;
  RobotModel model;
  Catalog catalog;
  TransitionCount count;
  BehaviorLog log{&count};
  CommandQueue queue;
  CommandSender sender{queue};
  Snapshot snapshot;
  std::unique_ptr<Behavior> behavior;
};

}  // namespace kadans::bench
