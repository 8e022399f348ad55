// One sandboxed Lua state. It has its own memory, a budget, only harmless library functions (sandbox.cpp lists them),
// and a `require` for "kadans", the project's behaviors/lib and the script's own folder.
//
// LuaJIT's compiler is off, because compiled loops run no hooks and the budget would not hold. The garbage collector
// does not run by itself; collect() runs it in the free time after a tick. One thread at a time.
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "budget.h"
#include "engine/behavior_log.h"
#include "script_error.h"

struct lua_State;

namespace kadans {

struct LuaCore;

// Takes the lines that scripts print, what their charts have to tell, and their transitions.
class ScriptVoice {
 public:
  virtual ~ScriptVoice() = default;
  virtual void say_with(BehaviorLog::Severity severity, const char* text) noexcept = 0;
  virtual void transitioned(const std::string& /*from*/, const std::string& /*to*/,
                            const std::string& /*why*/) noexcept {}
};

class LuaState {
 public:
  struct Settings {
    std::filesystem::path root;    // of the project; messages name files relative to it
    std::filesystem::path folder;  // the script's folder; `require` searches it before <root>/behaviors/lib
    std::string name;              // name of the random stream
    std::uint64_t seed = 1;
    ScriptLimits limits;
    ScriptVoice* voice = nullptr;
  };
  // A loaded file, kept to find lines for messages and to know the files of a reload.
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

  // Runs function(state, argument pushed as light userdata) under a budget. False: error() says why. Its results are
  // dropped. Errors unwind through the function, so it must not hold objects that need a destructor.
  [[nodiscard]] bool call(int (*function)(lua_State*), void* argument, std::uint64_t instructions,
                          std::int64_t wall_ns) noexcept;
  // The same with work(state), of which what was said of the function holds.
  template <typename Work>
  [[nodiscard]] bool call(Work work, std::uint64_t instructions, std::int64_t wall_ns) noexcept {
    const auto function = [](lua_State* state) { return (*static_cast<Work*>(argument_of(state)))(state), 0; };
    return call(function, &work, instructions, wall_ns);
  }
  // Throws InputError in place of false.
  template <typename Work>
  void call_or_throw(Work work, std::uint64_t instructions, std::int64_t wall_ns) {
    if (!call(work, instructions, wall_ns)) throw_error();
  }

  // Compiles a text file and leaves the function on the stack of `state`. False: the error message is on the stack.
  bool load_file(lua_State* state, const std::filesystem::path& path);
  // The file in which `require` finds a module; empty when there is none.
  std::filesystem::path find_module(std::string_view name) const;
  // The names of the files that `require` could find, without those in folders; at most 64.
  std::vector<std::string> module_names() const;
  std::string_view line_text(std::string_view chunk, int line) const noexcept;
  // The first line from `from` on that contains `text` in quotes or as a word; `from` when there is none.
  int line_of(std::string_view chunk, int from, std::string_view text) const;
  // The instructions that this search takes at most.
  double search_instructions(std::string_view chunk) const noexcept;

  // Runs the collector in proportion to the bytes that were allocated since the last call; to the end of its cycle when
  // three quarters of the memory are in use. With a limit of time it runs at most as long as a tick may, and continues
  // in the next call.
  void collect() noexcept;
  std::size_t used_bytes() const noexcept;

 private:
  std::string_view text_of(std::string_view chunk) const noexcept;  // "": there is no such file
  static void* argument_of(lua_State* state) noexcept;
  [[noreturn]] void throw_error() const;
  void collect_in_time(int kB) noexcept;

  Settings settings_;
  std::unique_ptr<LuaCore> core_;
  lua_State* lua_ = nullptr;
  std::vector<Source> sources_;
  std::uint64_t collected_at_ = 0;
};

}  // namespace kadans
