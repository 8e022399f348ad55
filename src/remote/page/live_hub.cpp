#include "live_hub.h"

#include <algorithm>
#include <cmath>

#include <nlohmann/json.hpp>
#include <unistd.h>

#include "config/json/foreign_json.h"
#include "live_client.h"
#include "live_protocol.h"
#include "remote/order/order_json.h"
#include "signal/input_file.h"
#include "signal/number_text.h"

namespace kadans {
namespace {

constexpr std::uint64_t report_every = 70, timing_every = 140, parameters_every = 14, drives_every = 28;  // beats
constexpr std::uint64_t own = 0;  // the hub's orders
constexpr std::uint32_t report_call = 1, describe_call = 2;

}  // namespace

bool LivePace::push(const std::string& what) {
  if (check_push) check_push(what);
  const std::lock_guard lock(mutex_);
  if (pushes_.size() == pushes_max) return false;
  pushes_.push_back(what);
  pushed_.store(true, std::memory_order_release);
  return true;
}

void LivePace::obey(const OrderRequest& request) {
  if (request.is("hold")) held = true;
  if (request.is("go")) held = false;
  if (request.is("step")) steps += 1;
  if (request.is("speed")) speed = request.number("times", 1);
  if (request.is("push") && !push(request.text("push"))) refuse("too many pushes wait");
}

std::vector<std::string> LivePace::take_pushes() {
  if (!pushed_.load(std::memory_order_acquire)) return {};
  const std::lock_guard lock(mutex_);
  pushed_.store(false, std::memory_order_relaxed);
  return std::exchange(pushes_, {});
}

LiveHub::LiveHub(Parts parts)
    : p_(std::move(parts)), channels_(p_.instance, p_.texts), assets_(p_.texts, p_.urdf_file) {
  const ParameterTable& table = p_.instance.catalog().parameters;
  for (ParameterId id = 0; id < table.size(); ++id) parameters_.push_back({table.info(id).name, table.newest(id)});
  tell_state();
}

void LiveHub::beat() {
  if (wanted_ != !clients_.empty()) {
    wanted_ = !clients_.empty();
    const double ticks = 1 / (rows_hz * p_.instance.facts().control_period_s);
    beats_ = 0;  // who comes first is told everything at once
    p_.port.want_signals(wanted_ ? static_cast<std::uint32_t>(std::max(1.0, std::floor(ticks))) : 0);
  }
  for (Event event; p_.port.next(event);) channels_.take(event);
  const InstanceStatus status = p_.port.status();
  const std::int64_t time_ns = status.time_ns;
  for (Fault fault; p_.port.next(fault);) channels_.take(fault, time_ns);
  changed_.clear();
  take_answers();
  if (!wanted_) return;
  const auto row = p_.port.signals();
  if (!row->values.empty() && row->tick != last_tick_) {
    last_tick_ = row->tick;
    channels_.take(*row);
  }
  if (beats_ % parameters_every == 0) take_parameters();
  if (beats_ % drives_every == 0)
    channels_.take_drives(json_text(drives_json(status.power, *p_.instance.catalog().model)), time_ns);
  if (beats_ % timing_every == 0 && !p_.timing.empty()) channels_.take_timing(timing_json(p_.timing), time_ns);
  if (beats_++ % report_every == 0 && !report_waits_)
    report_waits_ = send({.kind = Order::Kind::report}, own, report_call);
}

const std::string& LiveHub::introduction(bool writes) {
  const std::string plays = listed(playable_names(p_.instance.facts().folders), {}, " ");
  if (plays != plays_) introductions_ = {};
  plays_ = plays;
  std::string& text = introductions_[writes ? 1 : 0];
  if (!text.empty()) return text;
  const Instance::Facts& facts = p_.instance.facts();
  nlohmann::ordered_json metadata(channels_.signals());
  metadata["mode"] = facts.mode;
  metadata["robot"] = facts.name;
  metadata["writes"] = writes ? "yes" : "no";
  metadata["verbs"] = brief_verbs(can_pace());
  metadata["plays"] = plays;
  return text = json_text({{"op", "serverInfo"},
                           {"name", "kadans " + facts.version + ": " + facts.name},
                           {"capabilities", {"parameters", "parametersSubscribe", "services", "assets"}},
                           {"supportedEncodings", nlohmann::ordered_json::array({"json"})},
                           {"metadata", metadata},
                           {"sessionId", std::to_string(getpid())}});
}

const std::string& LiveHub::advertisement() {
  if (!advertisement_.empty()) return advertisement_;
  nlohmann::ordered_json channels = nlohmann::ordered_json::array();
  for (std::size_t i = 0; i < channels_.all().size(); ++i) {
    const LiveChannel& channel = channels_.all()[i];
    channels.push_back({{"id", i + 1},
                        {"topic", channel.topic},
                        {"encoding", channel.encoding},
                        {"schemaName", channel.schema_name},
                        {"schema", channel.schema},
                        {"schemaEncoding", channel.schema_encoding}});
  }
  return advertisement_ = json_text({{"op", "advertise"}, {"channels", channels}});
}

bool LiveHub::send(Order order, std::uint64_t client, std::uint32_t call) {
  order.client = client;
  const std::uint64_t number = p_.port.send(std::move(order));
  if (number == 0) return false;
  waiting_[number] = {client, call};
  return true;
}

void LiveHub::leave(std::uint64_t id) {
  clients_.erase(id);
  for (const auto& [order, caller] : waiting_) {
    if (caller.client == id) p_.port.withdraw(order);
  }
}

void LiveHub::bound_replies() noexcept {
  std::size_t sum = 0;
  LiveClient* largest = nullptr;
  const auto before = [](const LiveClient& a, const LiveClient& b) {  // those without the token go first
    const bool a_reads = !a.writes() && a.reply_bytes() > 0, b_reads = !b.writes() && b.reply_bytes() > 0;
    return a_reads != b_reads ? a_reads : a.reply_bytes() > b.reply_bytes();
  };
  for (const auto& [id, client] : clients_) {
    sum += client->reply_bytes();
    if (largest == nullptr || before(*client, *largest)) largest = client;
  }
  if (sum > replies_max_bytes && largest != nullptr) largest->give_up();
}

void LiveHub::take_answers() {
  for (Answer answer; p_.port.next(answer); answer = {}) {
    const auto found = waiting_.find(answer.number);
    if (found == waiting_.end()) continue;
    const Caller caller = found->second;
    waiting_.erase(found);
    if (caller.client != own) {
      const auto client = clients_.find(caller.client);
      if (client != clients_.end()) client->second->take(caller.call, answer);
      continue;
    }
    take_own(caller.call, answer);
  }
}

void LiveHub::take_own(std::uint32_t call, const Answer& answer) {
  if (call == report_call) take_report(answer);
  if (call == describe_call && answer.done) channels_.take_behaviors(answer.text);
}

void LiveHub::take_report(const Answer& answer) {
  report_waits_ = false;
  behaviors_now_.clear();
  std::map<std::string, std::uint64_t> charts;
  for (const BehaviorReport& behavior : answer.behaviors) {
    charts[behavior.name] = behavior.chart;
    for (const ScriptParameter& p : behavior.parameters)
      behaviors_now_.push_back({behavior.name + "." + p.name, p.value});
  }
  // Others play now, or new versions; those of the start are described already.
  if (charts != charts_ && send({.kind = Order::Kind::describe}, own, describe_call)) charts_ = std::move(charts);
  paused_ = answer.paused;
  tell_state();
}

void LiveHub::note(const std::string& name, double value) {
  const auto known = std::ranges::find(parameters_, name, &LiveParameter::name);
  if (known == parameters_.end()) {
    parameters_.push_back({name, value});
  } else if (known->value == value) {
    return;
  } else {
    known->value = value;
  }
  changed_.push_back({name, value});
}

void LiveHub::settled(const std::string& name, double value) {
  note(name, value);
  const auto reported = std::ranges::find(behaviors_now_, name, &LiveParameter::name);
  if (reported != behaviors_now_.end()) reported->value = value;  // until the next report says so too
}

void LiveHub::take_parameters() {
  const ParameterTable& table = p_.instance.catalog().parameters;
  for (ParameterId id = 0; id < table.size(); ++id) {  // the first of the list, in their order
    const double value = table.newest(id);
    if (parameters_[id].value == value) continue;
    parameters_[id].value = value;
    changed_.push_back(parameters_[id]);
  }
  for (const LiveParameter& p : behaviors_now_) note(p.name, p.value);
}

Answer LiveHub::save(const Answer& answer, const std::string& who, const std::string& preset) {
  return saved(p_.instance, p_.port, answer, who, preset);
}

void LiveHub::act(const OrderRequest& request, const std::string& who) {
  if (request.is("estop")) return p_.instance.stop_now(who);
  p_.pace->obey(request);
  tell_state();
}

void LiveHub::tell_state() {
  nlohmann::ordered_json json{{"paused", paused_}};
  if (p_.pace != nullptr) {
    json["held"] = p_.pace->held.load();
    json["speed"] = p_.pace->speed.load();
  }
  const std::string text = json_text(json);
  if (text == state_) return;
  state_ = text;
  ++state_count_;
}

}  // namespace kadans
