// Messages of the Debug Adapter Protocol: a head with the length, an empty line, a text in JSON. What comes in is from
// outside: a head is short, a text at most 4 MB, and JSON is read with bounds (config/json/foreign_json.h).
#pragma once

#include <optional>
#include <string>

#include <nlohmann/json.hpp>

namespace kadans {

class DapStream {
 public:
  DapStream(int in, int out) noexcept : in_(in), out_(out) {}

  int input() const noexcept { return in_; }
  // Takes what can be read now; waits when there is nothing. False at the end.
  [[nodiscard]] bool read();
  // The next whole message of what was read. Throws InputError when it is none; then nothing more can be understood.
  std::optional<nlohmann::ordered_json> next();
  void send(nlohmann::ordered_json message);  // with its number

 private:
  int in_, out_;
  int sequence_ = 0;
  std::string taken_;
};

}  // namespace kadans
