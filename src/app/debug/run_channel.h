// One end of the talk between the debugger and a process of the run that is debugged: texts in JSON, and with one of
// them the end of a talk with a further process. Both sides are this program, so what they say is not checked.
#pragma once

#include <compare>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <utility>

#include <nlohmann/json.hpp>

#include "signal/owned_descriptor.h"

namespace kadans {

using Json = nlohmann::ordered_json;

// A moment of a run, the same whenever the run is repeated: the control ticks that are over, and what has happened
// since then: lines of Lua, transitions, faults, errors of scripts. 0: between two ticks.
struct RunPosition {
  std::uint64_t tick = 0, point = 0;

  friend auto operator<=>(const RunPosition&, const RunPosition&) = default;
};
inline void to_json(Json& json, const RunPosition& at) { json = Json::array({at.tick, at.point}); }
inline void from_json(const Json& json, RunPosition& at) { json.at(0).get_to(at.tick), json.at(1).get_to(at.point); }

// A breakpoint on a line, as the editor sets it.
struct LineBreak {
  int id = 0;
  std::string chunk;
  int line = 0;
  std::string condition, hits, log;
};
inline void to_json(Json& json, const LineBreak& one) {
  json = Json::array({one.id, one.chunk, one.line, one.condition, one.hits, one.log});
}
inline void from_json(const Json& json, LineBreak& one) {
  json.at(0).get_to(one.id), json.at(1).get_to(one.chunk), json.at(2).get_to(one.line);
  json.at(3).get_to(one.condition), json.at(4).get_to(one.hits), json.at(5).get_to(one.log);
}

// A breakpoint on a state, or on a condition of signals.
struct NamedBreak {
  int id = 0;
  std::string text;
};
inline void to_json(Json& json, const NamedBreak& one) { json = Json::array({one.id, one.text}); }
inline void from_json(const Json& json, NamedBreak& one) { json.at(0).get_to(one.id), json.at(1).get_to(one.text); }

// False: whoever reads is gone. SIGPIPE must be ignored.
bool write_all(int descriptor, std::string_view bytes) noexcept;

// SIGPIPE must be ignored.
class RunChannel {
 public:
  RunChannel() = default;
  explicit RunChannel(int socket) noexcept : socket_(socket) {}

  static std::pair<RunChannel, RunChannel> make_pair();  // throws std::system_error

  // False: the other side is gone. `end` is given to it.
  bool send(const Json& json, const RunChannel* end = nullptr) const noexcept;
  // Waits. nullopt: the other side is gone.
  std::optional<Json> receive(RunChannel* end = nullptr) const;
  bool waiting() const noexcept;  // something, or the end of the other side
  bool open() const noexcept { return static_cast<bool>(socket_); }
  int socket() const noexcept { return socket_.number(); }
  void close() noexcept { socket_ = {}; }

 private:
  OwnedDescriptor socket_;
};

}  // namespace kadans
