#include "kadans/remote/live_server.h"

#include <algorithm>
#include <atomic>
#include <chrono>
#include <csignal>
#include <list>
#include <system_error>
#include <thread>

#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/steady_timer.hpp>
#include <pthread.h>
#include <sys/random.h>
#include <sys/resource.h>
#include <unistd.h>

#include "kadans/signal/input_error.h"
#include "live_connection.h"

namespace kadans {

namespace asio = boost::asio;
using Tcp = asio::ip::tcp;
using Error = boost::system::error_code;

std::string new_token() {
  unsigned char bytes[16];
  if (getrandom(bytes, sizeof bytes, 0) != static_cast<ssize_t>(sizeof bytes))
    throw std::system_error(errno, std::generic_category(), "no random numbers for a token");
  std::string text;
  for (const unsigned char byte : bytes) {
    constexpr const char* digits = "0123456789abcdef";
    text += {digits[byte >> 4U], digits[byte & 15U]};
  }
  return text;
}

struct LiveServer::Parts {
  static constexpr std::size_t connections_max = 300;
  static constexpr int niceness = 5;

  Parts(LiveSettings wanted, LiveHub* hub, RecordSite record)
      : settings(std::move(wanted)), site{hub, std::move(record), settings.token} {
    listen();
  }

  void listen() {
    Error error;
    const auto address = asio::ip::make_address(settings.address, error);
    if (error) throw InputError({.message = "'" + settings.address + "' is no address to listen on"});
    const Tcp::endpoint endpoint(address, settings.port);
    acceptor.open(endpoint.protocol(), error);
    if (!error) acceptor.set_option(Tcp::acceptor::reuse_address(true), error);
    if (!error) acceptor.bind(endpoint, error);
    if (!error) acceptor.listen(asio::socket_base::max_listen_connections, error);
    if (error)
      throw InputError({.message = "cannot listen on " + settings.address + " port " + std::to_string(settings.port) +
                                   ": " + error.message()});
    port = acceptor.local_endpoint().port();
  }

  void accept() {
    acceptor.async_accept([this](const Error& error, Tcp::socket socket) {
      if (error == asio::error::operation_aborted) return;
      if (!error && connections.size() < connections_max) {
        connections.push_back(make_live_connection(std::move(socket), site, ++last_id));
        connections.back()->start();
      }
      accept();
    });
  }

  // On a grid; after a while in which the machine was busy no beats are caught up.
  void plan_beat() {
    constexpr std::chrono::nanoseconds period(std::int64_t(1e9 / LiveHub::rate_hz));
    due = std::max(due + period, std::chrono::steady_clock::now());
    timer.expires_at(due);
    timer.async_wait([this](const Error& error) {
      if (error) return;
      beat();
      plan_beat();
    });
  }

  void beat() {
    if (site.hub != nullptr) site.hub->beat();
    std::uint32_t count = 0;
    for (const auto& connection : connections) {
      connection->beat();
      count += connection->is_client() ? 1U : 0U;
    }
    clients.store(count, std::memory_order_relaxed);
    connections.remove_if([](const auto& connection) { return connection->over(); });
  }

  void run() {
    (void)pthread_setname_np(pthread_self(), "live");
    (void)setpriority(PRIO_PROCESS, static_cast<id_t>(gettid()), niceness);  // of this thread alone
    accept();
    plan_beat();
    context.run();
  }

  LiveSettings settings;
  LiveSite site;
  std::uint16_t port = 0;
  asio::io_context context{1};
  Tcp::acceptor acceptor{context};
  asio::steady_timer timer{context};
  std::chrono::steady_clock::time_point due;
  std::list<std::unique_ptr<LiveConnection>> connections;
  std::uint64_t last_id = 0;
  std::atomic<std::uint32_t> clients{0};
  std::thread thread;
};

LiveServer::LiveServer(LiveSettings settings, LiveHub* hub, RecordSite site) {
  if (settings.token.empty()) settings.token = new_token();
  parts_ = std::make_unique<Parts>(std::move(settings), hub, std::move(site));
}

LiveServer::~LiveServer() { stop(); }

void LiveServer::start() {
  // Signals are for the thread that started us.
  sigset_t all, before;
  sigfillset(&all);
  pthread_sigmask(SIG_BLOCK, &all, &before);
  parts_->thread = std::thread([this] { parts_->run(); });
  pthread_sigmask(SIG_SETMASK, &before, nullptr);
}

void LiveServer::stop() noexcept {
  if (!parts_->thread.joinable()) return;
  parts_->context.stop();
  parts_->thread.join();
}

std::uint16_t LiveServer::port() const noexcept { return parts_->port; }
const std::string& LiveServer::token() const noexcept { return parts_->site.token; }
std::uint32_t LiveServer::clients() const noexcept { return parts_->clients.load(std::memory_order_relaxed); }

std::string LiveServer::url() const {
  const std::string& address = parts_->settings.address;
  const std::string host = address == "0.0.0.0" ? "127.0.0.1" : address;
  return "http://" + host + ":" + std::to_string(port()) + "/?token=" + token();
}

}  // namespace kadans
