// A console: takes a line and returns text. A line is Lua, or a command that begins with a colon. Lua is evaluated
// between two ticks in an environment of its own with a budget of its own. The console only reads until `:write`; then
// m.<object> commands the control objects, and each line is one transaction. The owner brings the lines and lets time
// go on.
//
// Besides the sandbox Lua sees: s (as behaviors do), signals.<name>, parameters.<name> of the control objects,
// behaviors.<name>.{state, active, outcome, error, parameters}, m, and k (require "kadans"). Globals stay from line to
// line.
//
// Behavior thread, between its ticks. Only the constructor throws.
#pragma once

#include <filesystem>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "config/scenario/play_item.h"
#include "engine/transaction.h"
#include "kadans/control/catalog.h"
#include "script/host/script_host.h"
#include "script/lua/budget.h"

namespace kadans {

class Console {
 public:
  struct Settings {
    std::filesystem::path root;  // of the project
    PlayFolders folders;         // for :play
    ScriptLimits limits{.tick_instructions = 1'000'000,
                        .load_instructions = 20'000'000,
                        .tick_wall_ns = 200'000'000,
                        .memory_bytes = std::size_t{16} << 20};
  };
  // What a line reads, and where its commands go.
  struct View {
    const Snapshot& snapshot;
    std::span<const double> signals;     // a row of the catalog's table
    std::span<const double> parameters;  // values by id
    CommandSender& commands;
  };
  struct Reply {
    std::string text;         // without a newline at its end
    bool error = false;       // the text is an error message
    bool incomplete = false;  // the next line continues this one
    bool quit = false;
    double run_s = 0;  // time to be simulated before the next line
  };
  struct Completion {
    std::size_t begin = 0;  // where the word begins in the text
    std::vector<std::string> words;
  };

  // `catalog` and `host` must outlive it. Throws InputError, std::bad_alloc.
  Console(const Settings& settings, const Catalog& catalog, ScriptHost& host);
  ~Console();
  Console(const Console&) = delete;
  Console& operator=(const Console&) = delete;

  Reply evaluate(std::string_view line, const View& view) noexcept;
  // The completions of the word at the end of the text.
  Completion complete(std::string_view text) noexcept;
  bool writes() const noexcept;

  struct Parts;

 private:
  Reply command(const std::string& line, const View& view) noexcept;
  Reply why(const std::string& name, const View& view) const noexcept;
  Reply run_lua(const View& view) noexcept;
  Reply order(PlayOrder::Kind kind, const std::string& line, std::size_t begin) noexcept;
  std::string status() const;

  std::unique_ptr<Parts> parts_;
};

}  // namespace kadans
