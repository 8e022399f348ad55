#include "bench/live/crowd.h"

#include <cstring>

#include <nlohmann/json.hpp>
#include <poll.h>
#include <sys/resource.h>
#include <unistd.h>

namespace kadans::bench {
namespace {

using Json = nlohmann::json;

constexpr int little_bytes = 4096, niceness = 10, look_again_ms = 50;

}  // namespace

Channels introduce(WebSocket& client) {
  for (;;) {
    const std::string text = client.next_message();
    if (text.empty() || text[0] != '{') continue;
    const Json json = Json::parse(text);
    if (json.at("op") != "advertise") continue;
    Channels found;
    found.count = json.at("channels").size();
    for (const Json& channel : json.at("channels")) {
      if (channel.at("topic") == "/timing") found.timing = channel.at("id");
      if (channel.at("topic") == "/joint") found.joint = channel.at("id");
    }
    return found;
  }
}

std::string subscription(std::uint32_t first, std::uint32_t last) {
  Json list = Json::array();
  for (std::uint32_t id = first; id <= last; ++id) list.push_back({{"id", id}, {"channelId", id}});
  return Json{{"op", "subscribe"}, {"subscriptions", list}}.dump();
}

Crowd::Crowd(std::uint16_t port, std::size_t clients) {
  for (std::size_t i = 0; i < clients; ++i) {
    const bool reads = i % 2 == 0;
    auto client = std::make_unique<WebSocket>(port, reads ? 0 : little_bytes);
    const Channels channels = introduce(*client);
    joint_ = channels.joint;
    client->send_text(subscription(1, static_cast<std::uint32_t>(channels.count)));
    (reads ? readers_ : others_).push_back(std::move(client));
  }
  thread_ = std::thread([this] { read(); });
}

Crowd::~Crowd() {
  over_ = true;
  thread_.join();
}

void Crowd::read() {
  (void)setpriority(PRIO_PROCESS, static_cast<id_t>(gettid()), niceness);
  std::vector<pollfd> wait;
  for (const auto& client : readers_) wait.push_back({client->descriptor(), POLLIN, 0});
  while (!over_) {
    if (poll(wait.data(), wait.size(), look_again_ms) <= 0) continue;
    for (std::size_t i = 0; i < wait.size(); ++i) {
      if (wait[i].revents == 0) continue;
      if (!readers_[i]->take()) lost_ = true, wait[i].fd = -1;
      take_messages(*readers_[i]);
    }
  }
}

// A message: 1, the number of the subscription, the time, the payload.
void Crowd::take_messages(WebSocket& client) {
  while (const auto message = client.message()) {
    bytes_ += message->size();
    std::uint32_t id = 0;
    if (message->size() < 13 || (*message)[0] != 1) continue;
    std::memcpy(&id, message->data() + 1, sizeof id);
    if (id == joint_) ++rows_;
  }
}

}  // namespace kadans::bench
