// What a client says to an instance over its socket: every whole line is answered by one line of JSON that says whether
// it was done, in the order in which they came.
//
// An input is the role, then pieces of what is said, each with its length in front.
#include <array>

#include <nlohmann/json.hpp>
#include <sys/socket.h>

#include "fuzz_input.h"
#include "fuzz_instance.h"
#include "remote/ctl/ctl_session.h"

namespace {

using namespace kadans;
using fuzz::require;

std::array<int, 2> sockets() {
  std::array<int, 2> ends{};
  require(socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC | SOCK_NONBLOCK, 0, ends.data()) == 0, "there are sockets");
  return ends;
}

struct Bench {
  fuzz::FuzzInstance instance;
  InstancePort& port = instance.instance.open_port();
  CtlCounts counts;
  CtlRequests requests{instance.instance, port, counts};
};

class Served {
 public:
  Served(Bench& bench, Role role) : bench_(bench), session_(ends_[0], role, 1, 0) {}
  ~Served() {
    bench_.requests.forget(session_);
    bench_.requests.upkeep();
    close(ends_[1]);
  }
  Served(const Served&) = delete;
  Served& operator=(const Served&) = delete;

  // As the server's thread does.
  void hear(std::string_view piece) {
    (void)!send(ends_[1], piece.data(), piece.size(), MSG_DONTWAIT | MSG_NOSIGNAL);
    if (!session_.receive(0)) return;
    for (std::string line; session_.take_line(line, 0);) answer(line);
    if (session_.watched.empty()) return;
    if (const std::string sample = bench_.requests.sample(session_); !sample.empty()) require_json(sample);
  }
  // Something other than a look at it was asked of the instance.
  bool changed() const noexcept { return changed_; }

 private:
  void answer(const std::string& line) {
    const std::string at_once = bench_.requests.take(session_, line);
    if (session_.order == 0) {
      changed_ = changed_ || at_once == R"({"ok":true})";
      return say(at_once);
    }
    changed_ = changed_ || !bench_.requests.reports(session_);
    for (int i = 0; i < 4 && session_.order != 0; ++i) {
      bench_.instance.step();
      for (Answer done; bench_.port.next(done);) {
        if (done.number == session_.order) say(bench_.requests.answered(session_, &done));
      }
    }
    if (session_.order != 0) say(bench_.requests.answered(session_, nullptr));
  }
  void say(const std::string& line) {
    require(line.find(R"("ok":)") != std::string::npos, "an answer says whether it is done");
    require_json(line);
    session_.say(line, 0);
    while (session_.wants_to_write()) {
      require(session_.transmit(0), "the client is there");
      for (std::array<char, 65536> bytes; recv(ends_[1], bytes.data(), bytes.size(), MSG_DONTWAIT) > 0;) {
      }
    }
  }
  static void require_json(const std::string& line) {
    require(line.starts_with('{') && line.find('\n') == std::string::npos && nlohmann::json::accept(line),
            "an answer is a line of JSON");
  }

  Bench& bench_;
  std::array<int, 2> ends_ = sockets();
  CtlSession session_;
  bool changed_ = false;
};

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static fuzz::KeptBench<Bench> kept;
  fuzz::FuzzInput input(data, size);
  bool changed = false;
  {
    Served served(kept.get(), static_cast<Role>(input.byte() % 3));
    while (!input.empty()) served.hear(input.take(input.byte()));
    changed = served.changed();
  }
  if (changed) kept.changed_by({reinterpret_cast<const char*>(data), size});
  return 0;
}
