#include "live_client.h"

#include <algorithm>
#include <cstring>
#include <optional>

#include <nlohmann/json.hpp>

#include "config/json/foreign_json.h"
#include "kadans/signal/input_error.h"
#include "live_protocol.h"
#include "remote/order/order_json.h"
#include "signal/input_file.h"

namespace kadans {
namespace {

constexpr std::size_t overhead_bytes = 64;  // of a reply in the queue
constexpr std::size_t id_max_bytes = 256;

// Numbers of subscriptions and requests. Throws InputError.
std::uint32_t whole_number(const Json& json) {
  if (json.is_number_unsigned() && json.get<std::uint64_t>() <= UINT32_MAX) return json.get<std::uint32_t>();
  refuse("an id is a whole number from 0 to 4294967295");
}

// What the client knows the answer by; "": it gave none. Throws InputError.
std::string request_id(const Json& json) {
  const auto id = json.find("id");
  if (id == json.end()) return "";
  if (id->is_string() && id->get_ref<const std::string&>().size() <= id_max_bytes) return *id;
  refuse("the id of a request is a string of at most 256 bytes");
}

}  // namespace

LiveClient::LiveClient(LiveHub& hub, std::uint64_t id, bool writes, std::string who)
    : hub_(hub), id_(id), writes_(writes), who_(std::move(who)) {
  put_text(hub_.introduction(writes_));
  put_text(hub_.advertisement());
  put_text(service_advertisement());
  hub_.enter(id_, *this);  // last: nothing throws any more
}

LiveClient::~LiveClient() { hub_.leave(id_); }

template <typename Act>
void LiveClient::guarded(Act act) noexcept {
  try {
    act();
  } catch (...) {
    give_up();
  }
}

void LiveClient::give_up() noexcept {
  hopeless_ = true;
  replies_.clear();
  reply_bytes_ = 0;
}

void LiveClient::put(Outgoing out) {
  if (hopeless_) return;
  reply_bytes_ += out.bytes.size() + overhead_bytes;
  replies_.push_back(std::move(out));
  if (reply_bytes_ > replies_max_bytes) give_up();
  hub_.bound_replies();
}

void LiveClient::say(const Json& json) { put_text(json_text(json)); }

void LiveClient::complain(const std::string& what) { say(Json{{"op", "status"}, {"level", 2}, {"message", what}}); }

void LiveClient::put_text(const std::string& text) {
  const std::span<const std::byte> bytes = bytes_of(text);
  put({false, {bytes.begin(), bytes.end()}});
}

void LiveClient::text(std::string_view json) noexcept {
  guarded([&] {
    try {
      obey(parse_foreign_json(json));
    } catch (const InputError& error) {
      complain(std::string("not understood: ") + error.what());
    } catch (const nlohmann::json::exception& error) {  // a field is missing or of another type
      complain(std::string("not understood: ") + error.what());
    }
  });
}

void LiveClient::obey(const Json& json) {
  const std::string op = json.at("op");
  if (op == "subscribe") return subscribe(json);
  if (op == "unsubscribe") {
    for (const Json& id : json.at("subscriptionIds")) subscriptions_.erase(whole_number(id));
  } else if (op == "getParameters") {
    get_parameters(json);
  } else if (op == "setParameters") {
    set_parameters(json);
  } else if (op == "subscribeParameterUpdates") {
    watch(json.at("parameterNames"));
  } else if (op == "unsubscribeParameterUpdates") {
    const Json& names = json.at("parameterNames");
    if (names.empty()) watches_all_ = false;
    for (const Json& name : names) {
      const auto watched = watched_.find(name.get<std::string>());
      if (watched == watched_.end()) continue;
      watched_bytes_ -= watched->size();
      watched_.erase(watched);
    }
  } else if (op == "fetchAsset") {
    fetch_asset(json);
  } else {
    complain("this server offers no such operation");
  }
}

void LiveClient::subscribe(const Json& json) {
  for (const Json& entry : json.at("subscriptions")) {
    const std::uint32_t id = whole_number(entry.at("id")), channel = whole_number(entry.at("channelId"));
    if (channel == 0 || channel > hub_.channels().all().size())
      return complain("there is no channel " + std::to_string(channel));
    if (subscriptions_.size() >= subscriptions_max && !subscriptions_.contains(id))
      return complain("a client has at most " + std::to_string(subscriptions_max) + " subscriptions");
    subscriptions_[id] = {channel - 1, 0};
  }
}

void LiveClient::watch(const Json& names) {
  watches_all_ = watches_all_ || names.empty();
  for (const Json& name : names) {
    const std::string text = name;
    if (watched_.contains(text)) continue;
    if (watched_.size() >= watched_max || watched_bytes_ + text.size() > watched_max_bytes)
      return complain("a client watches at most " + std::to_string(watched_max) + " parameters, whose names have " +
                      std::to_string(watched_max_bytes) + " bytes together");
    watched_bytes_ += text.size();
    watched_.insert(text);
  }
}

void LiveClient::get_parameters(const Json& json) {
  std::set<std::string, std::less<>> names;
  for (const Json& name : json.at("parameterNames")) names.insert(name.get<std::string>());
  Json found = Json::array();
  for (const LiveParameter& p : hub_.parameters()) {
    if (names.empty() || names.contains(p.name)) found.push_back(parameter_json(p));
  }
  Json answer{{"op", "parameterValues"}, {"parameters", found}};
  if (const std::string id = request_id(json); !id.empty()) answer["id"] = id;
  say(answer);
}

void LiveClient::set_parameters(const Json& json) {
  if (!writes_) return complain("parameters are changed with the token that the server printed when it began");
  const std::string id = request_id(json);
  for (const Json& p : json.at("parameters")) {
    const std::string name = p.at("name");
    if (!p.at("value").is_number()) {
      complain(name + ": a number is needed");
      continue;
    }
    if (calls_.size() >= calls_max) return complain("too many orders wait");
    const std::uint32_t call = ++next_call_;
    const bool sent =
        hub_.send({.kind = Order::Kind::set_parameter, .text = name, .value = p.at("value").get<double>(), .who = who_},
                  id_, call);
    if (!sent) {
      complain(name + ": too many orders wait");
      continue;
    }
    calls_[call] = {.parameter = name, .parameter_request = id, .value = p.at("value")};
  }
}

void LiveClient::fetch_asset(const Json& json) {
  const std::string uri = json.at("uri");
  const LiveAssets::Content content = hub_.assets().read(uri);
  put({true, asset_response(whole_number(json.at("requestId")), uri, content.get())});
}

void LiveClient::binary(std::span<const std::byte> bytes) noexcept {
  guarded([&] {
    if (!bytes.empty() && bytes[0] == std::byte{2}) return call_service(bytes);
    complain("this server takes service calls and no other binary message");
  });
}

void LiveClient::call_service(std::span<const std::byte> bytes) {
  const std::optional<ServiceCall> call = read_service_call(bytes);
  if (!call || call->service != command_service) return complain("a service call that this server does not know");
  if (!writes_) return say(service_failure(call->call, "orders need the token that the server printed"));
  try {
    command(call->call, read_brief_request(parse_foreign_json(call->request), hub_.can_pace()));
  } catch (const InputError& error) {
    say(service_failure(call->call, std::string("not understood: ") + error.what()));
  }
}

void LiveClient::command(std::uint32_t service_call, const OrderRequest& request) {
  if (!request.info->kind) {
    hub_.act(request, who_);
    return answer_service(service_call, true, "");
  }
  const std::uint32_t call = ++next_call_;
  if (calls_.size() >= calls_max || !hub_.send(request.order(who_), id_, call))
    return say(service_failure(service_call, "too many orders wait"));
  calls_[call] = {
      .service = true, .save = request.is("save"), .preset = request.text("preset"), .service_call = service_call};
}

void LiveClient::answer_service(std::uint32_t service_call, bool done, const std::string& text) {
  put({true, service_response(service_call, json_text(Json{{"done", done}, {"text", text}}))});
}

void LiveClient::take(std::uint32_t number, const Answer& answer) noexcept {
  const auto found = calls_.find(number);
  if (found == calls_.end()) return;
  guarded([&] {
    const Call call = std::move(found->second);
    calls_.erase(found);
    answer_call(call, answer);
  });
}

void LiveClient::answer_call(const Call& call, const Answer& answer) {
  if (call.save) {
    const Answer saved = hub_.save(answer, who_, call.preset);
    return answer_service(call.service_call, saved.done, saved.text);
  }
  if (call.service && !answer.reasons.empty()) {
    const Json told{{"done", true}, {"text", answer.text}, {"reasons", reasons_json(answer)}};
    return put({true, service_response(call.service_call, json_text(told))});
  }
  if (call.service) return answer_service(call.service_call, answer.done, answer.text);
  if (!answer.done) complain(answer.text);
  if (answer.done) hub_.settled(call.parameter, call.value);
  // As it is now, also after a refusal, so that the client's slider goes back.
  const auto now = std::ranges::find(hub_.parameters(), call.parameter, &LiveParameter::name);
  if (now == hub_.parameters().end() || (call.parameter_request.empty() && answer.done)) return;
  Json values{{"op", "parameterValues"}, {"parameters", Json::array({parameter_json(*now)})}};
  if (!call.parameter_request.empty()) values["id"] = call.parameter_request;
  say(values);
}

void LiveClient::tell_changes() noexcept {
  guarded([this] {
    Json changed = Json::array();
    for (const LiveParameter& p : hub_.changed()) {
      if (watches_all_ || watched_.contains(p.name)) changed.push_back(parameter_json(p));
    }
    if (!changed.empty()) say(Json{{"op", "parameterValues"}, {"parameters", changed}});
    if (state_told_ == hub_.state_count() || !writes_) return;
    state_told_ = hub_.state_count();
    say(Json{{"op", "status"}, {"level", 0}, {"message", hub_.state()}, {"id", "kadans.state"}});
  });
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
    out = {true, message_data(at->first, message->time_ns, message->payload)};
    return true;
  }
  return false;
}

}  // namespace kadans
