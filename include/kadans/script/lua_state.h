// One Lua state, closed in: its own memory, a budget, only the library functions that cannot harm (sandbox.cpp lists
// them), and `require` for "kadans", the project's behaviors/lib and the script's own folder.
//
// LuaJIT's compiler is off, since a budget must hold (compiled loops run no hooks). The collector is stopped; collect()
// steps it, in the slack after a tick. One thread at a time.
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "kadans/engine/behavior_host.h"
#include "kadans/script/script_error.h"
#include "kadans/script/script_limits.h"

struct lua_State;

namespace kadans {

struct LuaCore;

// Takes what scripts print.
class ScriptVoice {
 public:
  virtual ~ScriptVoice() = default;
  virtual void say(const char* text) noexcept = 0;
  virtual void say_with(BehaviorLog::Severity severity, const char* text) noexcept {
    (void)severity;
    say(text);
  }
};

class LuaState {
 public:
  struct Settings {
    std::filesystem::path root;    // of the project; files are named relative to it in messages
    std::filesystem::path folder;  // the script's own, searched by `require` before <root>/behaviors/lib
    std::string name;              // of the random stream
    std::uint64_t seed = 1;
    ScriptLimits limits;
    ScriptVoice* voice = nullptr;
  };
  // A loaded file: kept to find lines for messages, and to know what a reload must watch.
  struct Source {
    std::string chunk;  // relative to the root
    std::filesystem::path path;
    std::string text;
  };

  explicit LuaState(Settings settings);  // throws std::bad_alloc
  ~LuaState();
  LuaState(const LuaState&) = delete;
  LuaState& operator=(const LuaState&) = delete;

  lua_State* get() const noexcept { return lua_; }
  LuaCore& core() noexcept { return *core_; }
  const Settings& settings() const noexcept { return settings_; }
  const std::vector<Source>& sources() const noexcept { return sources_; }
  const ScriptError& error() const noexcept;

  // Runs function(state, argument pushed as light userdata) under a budget. False: error() says why.
  // What the function returns is dropped; errors unwind through it, so it holds nothing that needs a destructor.
  [[nodiscard]] bool call(int (*function)(lua_State*), void* argument, std::uint64_t instructions,
                          std::int64_t wall_ns) noexcept;

  // Compiles a file, text only, and leaves the function on the stack of `state`. False: the message is there.
  bool load_file(lua_State* state, const std::filesystem::path& path);
  // Where `require` finds a module; empty when nowhere.
  std::filesystem::path find_module(std::string_view name) const;
  // The first line from `from` on that holds `text` between quotes or as a word; `from` itself when none does.
  int line_of(std::string_view chunk, int from, std::string_view text) const;
  // What that takes at most.
  double search_instructions(std::string_view chunk) const noexcept;

  // Steps the collector, in proportion to what was allocated since the last call; to the end once three quarters of the
  // memory are in use. Where time is limited it takes as long as a tick may at most, and goes on the next time.
  void collect() noexcept;
  std::size_t used_bytes() const noexcept;

 private:
  void collect_in_time(int kB) noexcept;

  Settings settings_;
  std::unique_ptr<LuaCore> core_;
  lua_State* lua_ = nullptr;
  std::vector<Source> sources_;
  std::uint64_t collected_at_ = 0;
};

}  // namespace kadans
