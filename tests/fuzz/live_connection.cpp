// The bytes of a connection to the live server: HTTP, and WebSocket frames behind an upgrade, in pieces of any size.
// Whatever comes, the connection is served or ends, what goes out is HTTP, and no picture is taken without the token.
//
// An input is what the server has, then pieces, each with its length (low byte first) in front.
#include "remote/page/live_connection.h"

#include <array>

#include <boost/asio/io_context.hpp>
#include <sys/socket.h>

#include "fuzz_input.h"
#include "fuzz_instance.h"

namespace {

using namespace kadans;
using fuzz::require;

constexpr const char* token = "0123456789abcdef0123456789abcdef";

struct Bench {
  fuzz::FuzzInstance instance;
  LiveHub hub{instance.hub_parts(nullptr)};
  fuzz::MemoryFile record{"a record"};
  boost::asio::io_context context{1};  // of one connection after the other
};

class Served {
 public:
  Served(Bench& bench, bool runs, bool has_record) : bench_(bench) {
    if (runs) site_.hub = &bench.hub;
    if (has_record) site_.record.file = bench.record.path();
    site_.record.take_frame = [this](const std::string&, const std::string&) { took_ = true; };
    require(socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC | SOCK_NONBLOCK, 0, ends_.data()) == 0, "there are sockets");
    boost::asio::ip::tcp::socket socket(bench_.context);
    socket.assign(boost::asio::ip::tcp::v4(), ends_[0]);
    connection_ = make_live_connection(std::move(socket), site_, 1);
    connection_->start();
    go_on();
  }
  ~Served() {
    close(ends_[1]);
    go_on();
    require(connection_->over(), "a connection whose client is gone is over");
  }
  Served(const Served&) = delete;
  Served& operator=(const Served&) = delete;

  void hear(std::string_view piece) {
    (void)!send(ends_[1], piece.data(), piece.size(), MSG_DONTWAIT | MSG_NOSIGNAL);
    go_on();
  }
  void beat() {
    bench_.instance.step();
    bench_.hub.beat();
    connection_->beat();
    go_on();
  }
  bool took() const noexcept { return took_; }

 private:
  void go_on() {
    std::size_t handled = 0;
    do {
      for (std::array<char, 65536> bytes;;) {
        const ssize_t count = recv(ends_[1], bytes.data(), bytes.size(), MSG_DONTWAIT);
        if (count <= 0) break;
        if (said_.size() < 16) said_.append(bytes.data(), static_cast<std::size_t>(count));
      }
      bench_.context.restart();
      handled = bench_.context.poll();
    } while (handled > 0);
    require(said_.size() < 7 || said_.starts_with("HTTP/1."), "the first that goes out is HTTP");
  }

  Bench& bench_;
  LiveCrowd crowd_;
  LiveSite site_{nullptr, {}, LiveAccess(token, {"robot"}), &crowd_};
  std::array<int, 2> ends_{};
  std::unique_ptr<LiveConnection> connection_;
  std::string said_;
  bool took_ = false;
};

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static fuzz::KeptBench<Bench> kept;
  fuzz::FuzzInput input(data, size);
  const std::uint8_t has = input.byte();
  std::string all;
  bool took = false;
  {
    Served served(kept.get(), (has & 1U) != 0, (has & 2U) != 0);
    while (!input.empty()) {
      const std::string_view piece = input.take(input.length());
      all += piece;
      served.hear(piece);
      if (input.empty()) served.beat();
    }
    took = served.took();
  }
  const bool trusted = all.find(token) != std::string::npos;
  require(!took || trusted, "no picture is taken without the token");
  if (trusted) kept.changed_by({reinterpret_cast<const char*>(data), size});
  return 0;
}
