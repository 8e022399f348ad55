// One client of a live server, without its socket. Its messages come in by text() and binary(); next() gives the
// outgoing messages whenever the socket has room. Foxglove WebSocket protocol (foxglove.sdk.v1 and
// foxglove.websocket.v1, which are the same in everything that is used here).
//
// Replies wait in a queue of at most `replies_max_bytes`. A client that asks and does not read is closed. When the
// replies of all clients together pass LiveHub::replies_max_bytes, the client with the most waiting bytes is closed.
// All other messages are taken from the channels when the socket has room, so a slow client delays only itself.
//
// Input of a client can end only that client: unreadable input is answered with an error, and an exception closes the
// connection. Only a client with the token may write (parameters, orders). Server's thread.
#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <map>
#include <set>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include "live_hub.h"

namespace kadans {

class LiveClient {
 public:
  static constexpr std::size_t replies_max_bytes = std::size_t{16} << 20U;
  static constexpr std::size_t subscriptions_max = 256, watched_max = 4096, watched_max_bytes = 64 * 1024,
                               calls_max = 256;

  struct Outgoing {
    bool binary = false;
    std::vector<std::byte> bytes;
  };

  // Queues the introduction of the server and its channels. `id` counts from 1.
  LiveClient(LiveHub& hub, std::uint64_t id, bool writes, std::string who);
  ~LiveClient();
  LiveClient(const LiveClient&) = delete;
  LiveClient& operator=(const LiveClient&) = delete;

  void text(std::string_view json) noexcept;
  void binary(std::span<const std::byte> bytes) noexcept;
  void take(std::uint32_t call, const Answer& answer) noexcept;
  // To be called after each beat of the hub.
  void tell_changes() noexcept;

  // False when there is nothing to send now.
  [[nodiscard]] bool next(Outgoing& out);
  // True when the connection must be closed: the client does not read its replies, or an exception occurred.
  bool hopeless() const noexcept { return hopeless_; }
  std::size_t reply_bytes() const noexcept { return reply_bytes_; }
  bool writes() const noexcept { return writes_; }  // the client has the token
  void give_up() noexcept;

 private:
  using Json = nlohmann::ordered_json;
  struct Subscription {
    std::size_t channel;
    std::uint64_t seen;
  };
  struct Call {
    bool service = false, save = false;
    std::string preset{};  // for a save
    std::uint32_t service_call = 0;
    std::string parameter{}, parameter_request{};  // the parameter's name; the client's id of the request
    double value = 0;
  };

  template <typename Act>
  void guarded(Act act) noexcept;
  void put(Outgoing out);
  void put_text(const std::string& text);
  void say(const Json& json);
  void complain(const std::string& what);
  void obey(const Json& json);
  void subscribe(const Json& json);
  void watch(const Json& names);
  void get_parameters(const Json& json);
  void set_parameters(const Json& json);
  void fetch_asset(const Json& json);
  void answer_call(const Call& call, const Answer& answer);
  void call_service(std::span<const std::byte> bytes);
  void command(std::uint32_t service_call, const OrderRequest& request);
  void answer_service(std::uint32_t service_call, bool done, const std::string& text);

  LiveHub& hub_;
  std::uint64_t id_;
  bool writes_;
  std::string who_;
  std::map<std::uint32_t, Subscription> subscriptions_;  // by the client's subscription id
  std::uint32_t last_served_ = 0;
  std::set<std::string, std::less<>> watched_;
  std::size_t watched_bytes_ = 0;
  bool watches_all_ = false;
  std::map<std::uint32_t, Call> calls_;
  std::uint32_t next_call_ = 0;
  std::uint64_t state_told_ = 0;
  std::deque<Outgoing> replies_;
  std::size_t reply_bytes_ = 0;
  bool hopeless_ = false;
};

}  // namespace kadans
