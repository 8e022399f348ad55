#include "live_server.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <cctype>
#include <chrono>
#include <system_error>
#include <thread>

#include <arpa/inet.h>
#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/steady_timer.hpp>
#include <pthread.h>
#include <sys/random.h>
#include <sys/resource.h>
#include <unistd.h>

#include "config/json/problems.h"
#include "live_connection.h"
#include "signal/input_file.h"
#include "signal/number_text.h"
#include "signal/quiet_thread.h"

namespace kadans {

namespace asio = boost::asio;
using Tcp = asio::ip::tcp;
using Error = boost::system::error_code;

struct LiveServer::Parts {
  static constexpr int niceness = 5;
  static constexpr std::chrono::milliseconds breath{50};  // when the system has no more to give
  static constexpr double record_hz = 20;                 // nothing moves there

  Parts(LiveSettings wanted, LiveHub* hub, RecordSite record)
      : settings(std::move(wanted)), site{hub, std::move(record), LiveAccess(settings.token, settings.hosts), &crowd} {
    listen();
  }

  void listen() {
    Error error;
    const auto address = asio::ip::make_address(settings.address, error);
    if (error) refuse("'" + settings.address + "' is no address to listen on");
    const Tcp::endpoint endpoint(address, settings.port);
    acceptor.open(endpoint.protocol(), error);
    if (!error) acceptor.set_option(Tcp::acceptor::reuse_address(true), error);
    if (!error) acceptor.bind(endpoint, error);
    if (!error) acceptor.listen(asio::socket_base::max_listen_connections, error);
    if (error)
      refuse("cannot listen on " + settings.address + " port " + std::to_string(settings.port) + ": " +
             error.message());
    port = acceptor.local_endpoint().port();
  }

  void accept() {
    acceptor.async_accept([this](const Error& error, Tcp::socket socket) {
      if (error == asio::error::operation_aborted) return;
      if (!error) take(std::move(socket));
      if (!error || error == asio::error::connection_aborted) return accept();
      // No descriptors or no memory are left: one of ours goes, and who knocks waits for a moment.
      (void)crowd.close_one();
      pause.expires_after(breath);
      pause.async_wait([this](const Error& ended) { ended ? void() : accept(); });
    });
  }

  void take(Tcp::socket socket) {
    try {
      crowd.take(make_live_connection(std::move(socket), site, ++last_id));
    } catch (const std::exception&) {  // it is gone already, or there is no memory for it
    }
  }

  // On a grid; after a while in which the machine was busy no beats are caught up.
  void plan_beat() {
    const std::chrono::nanoseconds period(std::int64_t(1e9 / (site.hub != nullptr ? site.hub->rate_hz() : record_hz)));
    due = std::max(due + period, std::chrono::steady_clock::now());
    timer.expires_at(due);
    timer.async_wait([this](const Error& error) {
      if (error) return;
      try {
        beat();
      } catch (const std::exception&) {  // memory was short: what is new is told in the next
      }
      plan_beat();
    });
  }

  void beat() {
    if (site.hub != nullptr) site.hub->beat();
    crowd.beat();
    clients.store(crowd.clients(), std::memory_order_relaxed);
  }

  void run() {
    (void)pthread_setname_np(pthread_self(), "live");
    (void)setpriority(PRIO_PROCESS, static_cast<id_t>(gettid()), niceness);  // of this thread alone
    accept();
    plan_beat();
    for (;;) {
      try {
        return static_cast<void>(context.run());
      } catch (const std::exception&) {  // of the system's own handlers; the next one is served
      }
    }
  }

  LiveSettings settings;
  LiveSite site;
  std::uint16_t port = 0;
  asio::io_context context{1};
  Tcp::acceptor acceptor{context};
  asio::steady_timer timer{context}, pause{context};
  std::chrono::steady_clock::time_point due;
  LiveCrowd crowd;  // their sockets end before the context does
  std::uint64_t last_id = 0;
  std::atomic<std::uint32_t> clients{0};
  std::thread thread;
};

namespace {

// 128 random bits from the system, in hexadecimal.
std::string new_token() {
  std::array<std::byte, 16> bytes{};
  if (getrandom(bytes.data(), bytes.size(), 0) != static_cast<ssize_t>(bytes.size()))
    throw std::system_error(errno, std::generic_category(), "no random numbers for a token");
  return hexadecimal(bytes);
}

// What would not come back as it was said, out of an address or a browser.
void refuse_unusable(const LiveSettings& settings) {
  const auto only = [](const std::string& text, std::string_view more) {
    return std::ranges::all_of(text, [more](unsigned char c) {
      return (c < 0x80U && std::isalnum(c) != 0) || more.find(static_cast<char>(c)) != std::string_view::npos;
    });
  };
  if (!only(settings.token, "-._~")) refuse("a token stands in addresses: letters, digits and any of -._~");
  for (const std::string& host : settings.hosts) {
    in6_addr ignored{};
    if (!host.empty() && (only(host, "-._") || inet_pton(AF_INET6, host.c_str(), &ignored) == 1)) continue;
    refuse(in_quotes(host) + " is no name of a machine: it goes without a port or brackets");
  }
}

}  // namespace

LiveServer::LiveServer(LiveSettings settings, LiveHub* hub, RecordSite site) {
  if (settings.token.empty()) settings.token = new_token();
  refuse_unusable(settings);
  parts_ = std::make_unique<Parts>(std::move(settings), hub, std::move(site));
}

LiveServer::~LiveServer() { stop(); }

void LiveServer::start() {
  const SignalsBlocked blocked;
  parts_->thread = std::thread([this] { parts_->run(); });
}

void LiveServer::stop() noexcept {
  if (!parts_->thread.joinable()) return;
  parts_->context.stop();
  parts_->thread.join();
}

std::uint16_t LiveServer::port() const noexcept { return parts_->port; }
const std::string& LiveServer::token() const noexcept { return parts_->site.access.token(); }
std::uint32_t LiveServer::clients() const noexcept { return parts_->clients.load(std::memory_order_relaxed); }

std::string LiveServer::url() const {
  const std::string& address = parts_->settings.address;
  std::string host = address == "0.0.0.0" ? "127.0.0.1" : address == "::" ? "::1" : address;
  if (host.find(':') != std::string::npos) host = "[" + host + "]";
  return "http://" + host + ":" + std::to_string(port()) + "/?token=" + token();
}

}  // namespace kadans
