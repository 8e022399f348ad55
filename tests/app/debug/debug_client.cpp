#include "debug_client.h"

#include <array>
#include <csignal>

#include <doctest/doctest.h>
#include <fcntl.h>
#include <netinet/in.h>
#include <sys/prctl.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

namespace kadans::program {

DebugClient::DebugClient(const std::filesystem::path& where, const std::string& arguments) {
  std::array<int, 2> in{}, out{};
  REQUIRE(pipe2(in.data(), O_CLOEXEC) == 0);
  REQUIRE(pipe2(out.data(), O_CLOEXEC) == 0);
  const std::string command =
      "cd '" + where.string() + "' && exec '" KADANS_BINARY_DIR "/kadans' debug " + arguments + " 2>/dev/null";
  pid_ = fork();
  if (pid_ == 0) {
    prctl(PR_SET_PDEATHSIG, SIGKILL);
    dup2(in[0], STDIN_FILENO);
    dup2(out[1], STDOUT_FILENO);
    execl("/bin/sh", "sh", "-c", command.c_str(), nullptr);
    _exit(127);
  }
  close(in[0]);
  close(out[1]);
  to_ = in[1];
  from_ = out[0];
}

DebugClient::DebugClient(int port) : to_(socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0)), from_(dup(to_)) {
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  address.sin_port = htons(static_cast<std::uint16_t>(port));
  REQUIRE(connect(to_, reinterpret_cast<const sockaddr*>(&address), sizeof address) == 0);
}

DebugClient::~DebugClient() { (void)end(); }

int DebugClient::end() {
  if (to_ >= 0) close(to_);
  to_ = -1;
  if (pid_ < 0) {
    if (from_ >= 0) close(from_);
    from_ = -1;
    return -1;
  }
  int status = 0;
  waitpid(pid_, &status, 0);
  close(from_);
  from_ = pid_ = -1;
  return WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
}

void DebugClient::write(const std::string& bytes) const {
  REQUIRE(::write(to_, bytes.data(), bytes.size()) == static_cast<ssize_t>(bytes.size()));
}

// Takes the next message.
bool DebugClient::read() {
  for (;;) {
    if (const std::size_t head = taken_.find("\r\n\r\n"); head != std::string::npos) {
      const std::size_t length = std::stoul(taken_.substr(16)), begin = head + 4;
      if (taken_.size() >= begin + length) {
        Json message = Json::parse(taken_.substr(begin, length));
        taken_.erase(0, begin + length);
        const bool event = message.at("type") == "event";
        if (event && message.at("event") == "output") {
          said_ += message.at("body").at("output").get<std::string>();
        } else {
          (event ? events_ : responses_).push_back(std::move(message));
        }
        return true;
      }
    }
    std::array<char, 65536> part{};
    const ssize_t got = ::read(from_, part.data(), part.size());
    if (got <= 0) return false;
    taken_.append(part.data(), static_cast<std::size_t>(got));
  }
}

DebugClient::Json DebugClient::ask(const std::string& command, const Json& arguments) {
  const Json request{{"seq", ++sequence_}, {"type", "request"}, {"command", command}, {"arguments", arguments}};
  const std::string text = request.dump();
  write("Content-Length: " + std::to_string(text.size()) + "\r\n\r\n" + text);
  while (responses_.empty() && read()) {
  }
  REQUIRE_MESSAGE(!responses_.empty(), command);
  Json response = std::move(responses_.front());
  responses_.pop_front();
  CHECK(response.at("request_seq") == sequence_);
  CHECK(response.at("command") == command);
  return response;
}

DebugClient::Json DebugClient::get(const std::string& command, const Json& arguments) {
  const Json response = ask(command, arguments);
  REQUIRE_MESSAGE(response.at("success") == true, command << ": " << response.value("message", ""));
  return response.value("body", Json::object());
}

DebugClient::Json DebugClient::wait(const std::string& event) {
  for (;;) {
    for (auto one = events_.begin(); one != events_.end(); ++one) {
      if (one->at("event") != event) continue;
      Json body = one->at("body");
      events_.erase(events_.begin(), one + 1);
      return body;
    }
    if (!read()) return {};
  }
}

DebugClient::Json DebugClient::begin(const Json& launch, const std::string& file, const Json& breakpoints) {
  (void)get("initialize", {{"adapterID", "kadans"}});
  (void)get("launch", launch);
  CHECK(!wait("initialized").is_null());
  if (!file.empty()) {
    const Json set = get("setBreakpoints", {{"source", {{"path", file}}}, {"breakpoints", breakpoints}});
    for (const Json& one : set.at("breakpoints")) CHECK(one.at("verified") == true);
  }
  (void)get("configurationDone");
  return wait("stopped");
}

DebugClient::Json DebugClient::go(const std::string& command, const Json& arguments) {
  (void)get(command, arguments);
  return wait("stopped");
}

std::string DebugClient::value(int frame, const std::string& scope, const std::string& name) {
  const Json scopes = get("scopes", {{"frameId", frame}}).at("scopes");
  for (const Json& one : scopes) {
    if (one.at("name") != scope) continue;
    const Json fields = get("variables", {{"variablesReference", one.at("variablesReference")}}).at("variables");
    for (const Json& field : fields) {
      if (field.at("name") == name) return field.at("value");
    }
  }
  return "none";
}

}  // namespace kadans::program
