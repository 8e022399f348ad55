#include "bench/live/tick_times.h"

#include <algorithm>
#include <utility>

#include <nlohmann/json.hpp>

#include "bench/live/crowd.h"

namespace kadans::bench {
namespace {

using Json = nlohmann::json;

Distribution distribution(const Json& json) {
  return {.count = json.at("count"), .limits_us = json.at("limits"), .within = json.at("within")};
}

}  // namespace

Distribution Distribution::since(const Distribution& before) const {
  Distribution result = *this;
  result.count -= before.count;
  for (std::size_t i = 0; i < result.within.size(); ++i) result.within[i] -= before.within[i];
  return result;
}

double Distribution::percentile_us(double share) const {
  const double wanted = share * count;
  double low_us = 0, below = 0;
  for (std::size_t i = 0; i < within.size(); ++i) {
    if (within[i] >= wanted) {
      const double part = within[i] > below ? (wanted - below) / (within[i] - below) : 1;
      return low_us + (limits_us[i] - low_us) * std::clamp(part, 0.0, 1.0);
    }
    low_us = limits_us[i];
    below = within[i];
  }
  return low_us;  // at least
}

TickTimes tick_times(std::uint16_t port) {
  WebSocket client(port);
  const Channels channels = introduce(client);
  client.send_text(subscription(channels.timing, channels.timing));
  for (bool fresh = false;;) {
    const std::string message = client.next_message();
    if (message.size() < 14 || message[0] != 1) continue;
    if (!std::exchange(fresh, true)) continue;  // the first may be from when somebody last looked
    const Json json = Json::parse(message.substr(13));
    return {distribution(json.at("Control tick: late")), distribution(json.at("Control tick: takes"))};
  }
}

}  // namespace kadans::bench
