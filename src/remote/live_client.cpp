#include "kadans/remote/live_client.h"

#include <algorithm>
#include <cstring>
#include <optional>

#include <nlohmann/json.hpp>

#include "live_protocol.h"

namespace kadans {
namespace {

constexpr std::size_t overhead_bytes = 64;  // of a reply in the queue

std::string joined(const std::vector<std::string>& names) {
  std::string text;
  for (const std::string& name : names) text += (text.empty() ? "" : " ") + name;
  return text;
}

}  // namespace

LiveClient::LiveClient(LiveHub& hub, std::uint64_t id, bool writes, std::string who)
    : hub_(hub), id_(id), writes_(writes), who_(std::move(who)) {
  hub_.enter(id_, *this);
  introduce();
  advertise();
}

LiveClient::~LiveClient() { hub_.leave(id_); }

void LiveClient::say(const std::string& json) {
  Outgoing out;
  const std::span<const std::byte> bytes = bytes_of(json);
  out.bytes.assign(bytes.begin(), bytes.end());
  reply_bytes_ += out.bytes.size() + overhead_bytes;
  replies_.push_back(std::move(out));
  hopeless_ = hopeless_ || reply_bytes_ > replies_max_bytes;
}

void LiveClient::say_binary(std::vector<std::byte> bytes) {
  reply_bytes_ += bytes.size() + overhead_bytes;
  replies_.push_back({true, std::move(bytes)});
  hopeless_ = hopeless_ || reply_bytes_ > replies_max_bytes;
}

void LiveClient::complain(const std::string& what) {
  say(Json{{"op", "status"}, {"level", 2}, {"message", what}}.dump());
}

void LiveClient::introduce() {
  Json metadata(hub_.channels().signals());
  metadata["mode"] = hub_.instance().facts().mode;
  metadata["robot"] = hub_.instance().facts().name;
  metadata["writes"] = writes_ ? "yes" : "no";
  metadata["verbs"] = verbs_text(hub_.can_pace());
  metadata["plays"] = joined(playable_names(hub_.instance().facts().folders));
  say(Json{{"op", "serverInfo"},
           {"name", "kadans " + hub_.instance().facts().version + ": " + hub_.instance().facts().name},
           {"capabilities", {"parameters", "parametersSubscribe", "services", "assets"}},
           {"supportedEncodings", Json::array({"json"})},
           {"metadata", metadata},
           {"sessionId", session_id()}}
          .dump());
}

void LiveClient::advertise() {
  Json channels = Json::array();
  for (std::size_t i = 0; i < hub_.channels().all().size(); ++i) {
    const LiveChannel& channel = hub_.channels().all()[i];
    channels.push_back({{"id", i + 1},
                        {"topic", channel.topic},
                        {"encoding", channel.encoding},
                        {"schemaName", channel.schema_name},
                        {"schema", channel.schema},
                        {"schemaEncoding", channel.schema_encoding}});
  }
  say(Json{{"op", "advertise"}, {"channels", channels}}.dump());
  say(service_advertisement());
}

void LiveClient::text(std::string_view json) {
  try {
    obey(json);
  } catch (const nlohmann::json::exception& error) {
    complain(std::string("not understood: ") + error.what());
  }
}

void LiveClient::obey(std::string_view text) {
  const Json json = Json::parse(text);
  const std::string op = json.at("op");
  if (op == "subscribe") return subscribe(json);
  if (op == "unsubscribe") {
    for (const Json& id : json.at("subscriptionIds")) subscriptions_.erase(id.get<std::uint32_t>());
  } else if (op == "getParameters") {
    get_parameters(json);
  } else if (op == "setParameters") {
    set_parameters(json);
  } else if (op == "subscribeParameterUpdates") {
    const Json& names = json.at("parameterNames");
    watches_all_ = watches_all_ || names.empty();
    for (const Json& name : names) watched_.insert(name.get<std::string>());
  } else if (op == "unsubscribeParameterUpdates") {
    const Json& names = json.at("parameterNames");
    if (names.empty()) watches_all_ = false;
    for (const Json& name : names) watched_.erase(name.get<std::string>());
  } else if (op == "fetchAsset") {
    fetch_asset(json);
  } else {
    complain("'" + op + "' is not offered by this server");
  }
}

template <typename J>
void LiveClient::subscribe(const J& json) {
  for (const J& entry : json.at("subscriptions")) {
    const std::uint32_t id = entry.at("id"), channel = entry.at("channelId");
    if (channel == 0 || channel > hub_.channels().all().size()) {
      complain("there is no channel " + std::to_string(channel));
      continue;
    }
    subscriptions_[id] = {channel - 1, 0};
  }
}

template <typename J>
void LiveClient::get_parameters(const J& json) {
  const J& names = json.at("parameterNames");
  Json found = Json::array();
  for (const LiveParameter& p : hub_.parameters()) {
    const auto is_it = [&](const J& name) { return name.template get<std::string>() == p.name; };
    if (names.empty() || std::any_of(names.begin(), names.end(), is_it)) found.push_back(parameter_json(p));
  }
  Json answer{{"op", "parameterValues"}, {"parameters", found}};
  if (json.contains("id")) answer["id"] = json.at("id");
  say(answer.dump());
}

template <typename J>
void LiveClient::set_parameters(const J& json) {
  if (!writes_) return complain("parameters are changed with the token that the server printed when it began");
  for (const J& p : json.at("parameters")) {
    const std::string name = p.at("name");
    if (!p.at("value").is_number()) {
      complain(name + ": a number is needed");
      continue;
    }
    const std::uint32_t call = ++next_call_;
    const bool sent = hub_.send(
        {.kind = Order::Kind::set_parameter, .text = name, .value = p.at("value").template get<double>(), .who = who_},
        id_, call);
    if (!sent) {
      complain(name + ": too many orders wait");
      continue;
    }
    calls_[call] = {.parameter = name,
                    .parameter_request = json.contains("id") ? json.at("id").dump() : "",
                    .value = p.at("value")};
  }
}

template <typename J>
void LiveClient::fetch_asset(const J& json) {
  const std::string uri = json.at("uri");
  say_binary(asset_response(json.at("requestId"), uri, hub_.assets().read(uri)));
}

void LiveClient::binary(std::span<const std::byte> bytes) {
  if (!bytes.empty() && bytes[0] == std::byte{2}) return call_service(bytes);
  complain("this server takes service calls and no other binary message");
}

void LiveClient::call_service(std::span<const std::byte> bytes) {
  const std::optional<ServiceCall> call = read_service_call(bytes);
  if (!call || call->service != command_service) return complain("a service call that this server does not know");
  try {
    const Json json = Json::parse(call->request);
    command(call->call, json.at("verb"), json.value("text", ""), json.value("value", 0.0));
  } catch (const nlohmann::json::exception& error) {
    say(service_failure(call->call, std::string("not understood: ") + error.what()));
  }
}

void LiveClient::command(std::uint32_t service_call, const std::string& verb, const std::string& text, double value) {
  if (!writes_) return say(service_failure(service_call, "orders need the token that the server printed"));
  const std::optional<Order::Kind> kind = order_of(verb);
  if (!kind) {
    if (hub_.act(verb, text, value)) {
      if (verb == "estop")
        (void)hub_.send({.kind = Order::Kind::note, .text = "asked for the emergency stop", .who = who_}, id_,
                        ++next_call_);
      return answer_service(service_call, true, "");
    }
    return say(service_failure(service_call, "'" + verb + "' is no order; there are " + verbs_text(hub_.can_pace())));
  }
  const std::uint32_t call = ++next_call_;
  if (!hub_.send({.kind = *kind, .text = text, .value = value, .who = who_}, id_, call))
    return say(service_failure(service_call, "too many orders wait"));
  calls_[call] = {.service = true, .save = *kind == Order::Kind::changes, .service_call = service_call};
}

void LiveClient::answer_service(std::uint32_t service_call, bool done, const std::string& text) {
  say_binary(service_response(service_call, Json{{"done", done}, {"text", text}}.dump()));
}

void LiveClient::save(std::uint32_t service_call, const Answer& answer) {
  try {
    answer_service(service_call, true, hub_.save(answer.changes));
  } catch (const std::exception& error) {
    answer_service(service_call, false, error.what());
  }
}

void LiveClient::take(std::uint32_t number, const Answer& answer) {
  const auto found = calls_.find(number);
  if (found == calls_.end()) return;
  const Call call = found->second;
  calls_.erase(found);
  if (call.save) return save(call.service_call, answer);
  if (call.service) return answer_service(call.service_call, answer.done, answer.text);
  if (!answer.done) complain(answer.text);
  if (answer.done) hub_.settled(call.parameter, call.value);
  // As it is now, also after a refusal, so that the client's slider goes back.
  const auto now = std::ranges::find(hub_.parameters(), call.parameter, &LiveParameter::name);
  if (now == hub_.parameters().end() || (call.parameter_request.empty() && answer.done)) return;
  Json values{{"op", "parameterValues"}, {"parameters", Json::array({parameter_json(*now)})}};
  if (!call.parameter_request.empty()) values["id"] = Json::parse(call.parameter_request);
  say(values.dump());
}

void LiveClient::tell_changes() {
  Json changed = Json::array();
  for (const LiveParameter& p : hub_.changed()) {
    if (watches_all_ || watched_.contains(p.name)) changed.push_back(parameter_json(p));
  }
  if (!changed.empty()) say(Json{{"op", "parameterValues"}, {"parameters", changed}}.dump());
  if (state_told_ == hub_.state_count() || !writes_) return;
  state_told_ = hub_.state_count();
  say(Json{{"op", "status"}, {"level", 0}, {"message", hub_.state()}, {"id", "kadans.state"}}.dump());
}

bool LiveClient::next(Outgoing& out) {
  if (!replies_.empty()) {
    out = std::move(replies_.front());
    replies_.pop_front();
    reply_bytes_ -= out.bytes.size() + overhead_bytes;
    return true;
  }
  // In turn, so that no channel starves another.
  auto at = subscriptions_.upper_bound(last_served_);
  for (std::size_t i = 0; i < subscriptions_.size(); ++i, ++at) {
    if (at == subscriptions_.end()) at = subscriptions_.begin();
    Subscription& subscription = at->second;
    const LiveMessage* message = hub_.channels().all()[subscription.channel].next(subscription.seen);
    if (message == nullptr) continue;
    last_served_ = at->first;
    put_message(at->first, *message, out);
    return true;
  }
  return false;
}

void LiveClient::put_message(std::uint32_t subscription, const LiveMessage& message, Outgoing& out) const {
  out.binary = true;
  out.bytes = message_data(subscription, message.time_ns, message.payload);
}

}  // namespace kadans
