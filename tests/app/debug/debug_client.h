// A client of the Debug Adapter Protocol, as an editor has one: `kadans debug` beside the test, on two pipes.
#pragma once

#include <deque>
#include <filesystem>
#include <string>

#include <nlohmann/json.hpp>
#include <sys/types.h>

namespace kadans::program {

class DebugClient {
 public:
  using Json = nlohmann::json;

  // The arguments behind `kadans debug`, in folder `where`.
  DebugClient(const std::filesystem::path& where, const std::string& arguments);
  explicit DebugClient(int port);  // connects to one that waits there
  ~DebugClient();
  DebugClient(const DebugClient&) = delete;
  DebugClient& operator=(const DebugClient&) = delete;

  // The whole response.
  Json ask(const std::string& command, const Json& arguments = Json::object());
  // The response's body; the request must succeed.
  Json get(const std::string& command, const Json& arguments = Json::object());
  // The body of the next event of this name; outputs are kept in said(). Null when the program ended before.
  Json wait(const std::string& event);
  // Initializes, launches, sets breakpoints in lines of one file and goes to the first stop.
  Json begin(const Json& launch, const std::string& file = "", const Json& breakpoints = Json::array());
  // Asks and waits until the run stands still again.
  Json go(const std::string& command, const Json& arguments = Json::object());
  Json position() { return get("kadans/position"); }
  Json frames(int thread) { return get("stackTrace", {{"threadId", thread}}).at("stackFrames"); }
  // The value of a field of the scope.
  std::string value(int frame, const std::string& scope, const std::string& name);
  void write(const std::string& bytes) const;  // as they are
  int end();                                   // closes its input; its exit code

  const std::string& said() const noexcept { return said_; }

 private:
  bool read();

  pid_t pid_ = -1;
  int to_ = -1, from_ = -1, sequence_ = 0;
  std::string taken_, said_;
  std::deque<Json> events_, responses_;
};

}  // namespace kadans::program
