// A console: takes a line, gives text. A line is Lua, evaluated between two ticks in an environment of its own and
// under its own budget, or a command that begins with a colon. It reads until `:write`: then m.<object> commands the
// control objects, each line one transaction. Where lines come from and time goes on is the owner's business.
//
// What Lua sees besides the sandbox: s (as behaviors do), signals.<name>, parameters.<name> of the control objects,
// behaviors.<name>.{state, outcome, error, parameters}, m, k (require "kadans"). Globals stay from line to line.
//
// Behavior thread, between its ticks. Nothing here throws but the constructor.
#pragma once

#include <filesystem>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "kadans/config/play_item.h"
#include "kadans/control/catalog.h"
#include "kadans/engine/transaction.h"
#include "kadans/script/script_host.h"
#include "kadans/script/script_limits.h"

namespace kadans {

class Console {
 public:
  struct Settings {
    std::filesystem::path root;  // of the project
    PlayFolders folders;         // for :play
    std::vector<std::string> feet{"left", "right"};
    ScriptLimits limits{.tick_instructions = 1'000'000,
                        .load_instructions = 20'000'000,
                        .tick_wall_ns = 200'000'000,
                        .memory_bytes = std::size_t{16} << 20};
  };
  // What a line sees and commands.
  struct View {
    const Snapshot& snapshot;
    std::span<const double> signals;     // a row of the catalog's table
    std::span<const double> parameters;  // values by id
    CommandSender& commands;
  };
  struct Reply {
    std::string text;         // without a newline at its end
    bool error = false;       // the text says what is wrong
    bool incomplete = false;  // the next line goes on with this one
    bool quit = false;
    double run_s = 0;  // to be simulated before the next line
  };
  struct Completion {
    std::size_t begin = 0;  // of the word in the text
    std::vector<std::string> words;
  };

  // Catalog and host must outlive it. Throws InputError, std::bad_alloc.
  Console(const Settings& settings, const Catalog& catalog, ScriptHost& host);
  ~Console();
  Console(const Console&) = delete;
  Console& operator=(const Console&) = delete;

  Reply evaluate(std::string_view line, const View& view) noexcept;
  // What the word at the end of the text may become.
  Completion complete(std::string_view text) noexcept;
  bool writes() const noexcept;

  struct Parts;

 private:
  Reply command(const std::string& line) noexcept;
  Reply run_lua(const View& view) noexcept;
  Reply order(PlayOrder::Kind kind, const std::string& line, std::size_t begin) noexcept;
  std::string status() const;

  std::unique_ptr<Parts> parts_;
};

}  // namespace kadans
