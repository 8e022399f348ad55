
#include "ctl_session.h"

#include <algorithm>
#include <array>
#include <cerrno>
#include <cmath>
#include <utility>

#include <sys/socket.h>
#include <unistd.h>

#include "config/json/problems.h"
#include "remote/order/order_json.h"
#include "signal/input_file.h"

namespace kadans {

CtlSession::CtlSession(int socket, Role role, std::uint64_t number, std::int64_t now_ns)
    : socket_(socket), role_(role), number_(number), heard_ns_(now_ns) {
  ucred peer{};
  socklen_t size = sizeof peer;
  const bool known = getsockopt(socket, SOL_SOCKET, SO_PEERCRED, &peer, &size) == 0;
  if (known) user_ = peer.uid;
  who_ = (known ? "uid " + std::to_string(user_) + " (" : std::string("(")) + name(role) + ")";
}

void CtlSession::note_half(std::int64_t now_ns) noexcept {
  if (in_.empty() || has_line()) {
    half_ns_ = INT64_MAX;
  } else if (half_ns_ == INT64_MAX) {
    half_ns_ = now_ns;
  }
}

bool CtlSession::receive(std::int64_t now_ns) {
  std::array<char, 16384> bytes;
  const ssize_t count = recv(socket(), bytes.data(), bytes.size(), MSG_DONTWAIT);
  if (count < 0) return errno == EAGAIN || errno == EINTR;
  ended_ = count == 0;
  if (count > 0) heard_ns_ = now_ns;
  in_.append(bytes.data(), static_cast<std::size_t>(count));
  note_half(now_ns);
  return !too_long();
}

bool CtlSession::transmit(std::int64_t now_ns) {
  const ssize_t count = send(socket(), out_.data(), out_.size(), MSG_DONTWAIT | MSG_NOSIGNAL);
  if (count < 0) return errno == EAGAIN || errno == EINTR;
  if (count > 0) progress_ns_ = now_ns;
  out_.erase(0, static_cast<std::size_t>(count));
  return true;
}

bool CtlSession::take_line(std::string& line, std::int64_t now_ns) {
  if (!out_.empty() || order != 0) return false;
  const std::size_t end = in_.find('\n');
  if (end == std::string::npos) return false;
  line.assign(in_, 0, end);
  in_.erase(0, end + 1);
  note_half(now_ns);
  return true;
}

std::vector<std::string> CtlSession::last_lines(std::int64_t now_ns) {
  constexpr int reads_max = 16;
  for (int i = 0; i < reads_max && !ended_ && receive(now_ns); ++i) {
  }
  std::vector<std::string> lines;
  std::size_t begin = 0;
  for (std::size_t end; (end = in_.find('\n', begin)) != std::string::npos; begin = end + 1)
    lines.push_back(in_.substr(begin, end - begin));
  in_.erase(0, begin);
  return lines;
}

void CtlSession::say(const std::string& line, std::int64_t now_ns) {
  if (out_.empty()) progress_ns_ = now_ns;
  out_ += line;
  out_ += '\n';
}

namespace {

constexpr double rate_usual_hz = 10;
constexpr std::size_t readers_waiting_max = orders_waiting_max / 2;  // the other places are of those who may act
constexpr std::uint32_t row_every_ticks = 10;                        // while nobody watches faster

Json change_json(const ParameterChange& change) {
  return {{"name", change.name}, {"before", change.before}, {"now", change.now}};
}

}  // namespace

CtlRequests::CtlRequests(Instance& instance, InstancePort& port, const CtlCounts& counts)
    : instance_(instance), port_(port), counts_(counts) {
  port_.want_signals(row_every_ticks);
}

CtlRequests::~CtlRequests() = default;

std::string CtlRequests::take(CtlSession& session, const std::string& line) {
  try {
    const OrderRequest request = read_request(line, session.role());
    if (session.leaves && !request.is("estop")) return refusal("orders expire with their client");
    if (known_here(request)) return told(session, request, {});
    return request.info->kind ? send(session, request) : at_once(session, request);
  } catch (const std::exception& error) {
    return refusal(error.what());
  }
}

// What the behavior thread need not be asked for.
bool CtlRequests::known_here(const OrderRequest& request) const {
  const std::string name = request.text("name"), what = request.text("what");
  const Catalog& catalog = instance_.catalog();
  if (request.is("get")) return catalog.signals.find(name) || catalog.parameters.find(name);
  return request.is("list") && what != "behaviors" && what != "parameters" && what != "events";
}

bool CtlRequests::reports(const CtlSession& session) const {
  return *asked_.at(session.number()).info->kind == Order::Kind::report;
}

std::string CtlRequests::at_once(CtlSession& session, const OrderRequest& request) {
  if (request.is("watch")) return watch(session, request);
  if (request.is("faults")) return faults();
  if (request.is("drives")) {
    Json drives = drives_json(port_.status().power, *instance_.catalog().model);
    drives["ok"] = true;
    return json_text(drives);
  }
  if (request.is("world")) {
    Json world = world_json(port_.status().seen, instance_.catalog().seen);
    world["ok"] = true;
    return json_text(world);
  }
  if (request.is("unwatch")) {
    session.watched.clear();
    watches_fast(session, false);
  } else {  // estop
    instance_.stop_now(session.who());
  }
  return json_text({{"ok", true}});
}

std::string CtlRequests::send(CtlSession& session, const OrderRequest& request) {
  Order order = request.order(session.who(), session.number());
  session.has_console = session.has_console || order.kind == Order::Kind::line || order.kind == Order::Kind::complete;
  const bool reads = session.role() == Role::read;
  const bool room = !reads || readers_.size() < readers_waiting_max;
  session.order = room ? port_.send(std::move(order)) : 0;
  if (session.order == 0) return refusal("too many orders wait for their answers; try again");
  if (reads) readers_.insert(session.number());
  asked_.insert_or_assign(session.number(), request);
  return {};
}

std::string CtlRequests::answered(CtlSession& session, const Answer* answer) {
  const OrderRequest request = asked_.at(session.number());
  const std::uint64_t order = std::exchange(session.order, 0);
  readers_.erase(session.number());
  try {
    if (answer == nullptr) port_.withdraw(order);
    if (answer == nullptr && !reports(session))
      return refusal("the behavior thread does not answer; estop works without it");
    if (answer == nullptr) {
      const Answer none;
      return request.is("status") ? status(nullptr) : told(session, request, none);
    }
    if (!answer->done && answer->text.empty() && !answer->incomplete) return refusal("refused");
    if (!answer->done && !answer->incomplete) return refusal(answer->text);
    return told(session, request, *answer);
  } catch (const std::exception& error) {
    return refusal(error.what());
  }
}

std::string CtlRequests::told(const CtlSession& session, const OrderRequest& request, const Answer& answer) {
  Json json{{"ok", true}};
  if (request.is("status")) {
    return status(&answer);
  } else if (request.is("list")) {
    json["items"] = list_json(request.text("what"), instance_, port_.status(), answer);
  } else if (request.is("get")) {
    return get(request.text("name"), answer);
  } else if (request.is("save")) {
    return save(session, request.text("preset"), answer);
  } else if (request.is("set") || request.is("undo")) {
    json.update(change_json(answer.changes.at(0)));
  } else if (request.is("complete")) {
    json["begin"] = answer.begin;
    json["words"] = answer.words;
  } else if (request.is("why")) {
    json["text"] = answer.text;
    json["reasons"] = reasons_json(answer);
  } else if (request.is("line")) {
    json.update({{"text", answer.text},
                 {"incomplete", answer.incomplete},
                 {"writes", answer.writes},
                 {"leaves", answer.leaves}});
  } else if (!answer.text.empty()) {
    json["text"] = answer.text;
  }
  return json_text(json);
}

std::string CtlRequests::status(const Answer* report) {
  Json json = status_json(instance_, port_.status());
  json["clients"] = {
      {"served", counts_.served.load()}, {"refused", counts_.refused.load()}, {"dropped", counts_.dropped.load()}};
  if (report == nullptr) {
    json["behaviors_error"] = "the behavior thread does not answer";
  } else {
    json["paused"] = report->paused;
    json["behaviors"] = behaviors_json(*report);
  }
  return json_text(json);
}

std::string CtlRequests::get(const std::string& name, const Answer& report) {
  const Catalog& catalog = instance_.catalog();
  if (const auto id = catalog.signals.find(name)) {
    const auto row = port_.signals();
    if (row->values.empty()) refuse("no tick was seen yet");
    const double value = row->values[*id];
    const Signal& info = catalog.signals.info(*id);
    Json json{{"ok", true},        {"kind", "signal"}, {"name", name},
              {"unit", info.unit}, {"doc", info.doc},  {"time_s", 1e-9 * static_cast<double>(row->time_ns)}};
    json["value"] = std::isfinite(value) ? Json(value) : Json(nullptr);
    return json_text(json);
  }
  std::vector<std::string> names = catalog.signals.names();
  for (Json& one : list_json("parameters", instance_, port_.status(), report)) {
    names.push_back(one["name"].get<std::string>());
    if (names.back() != name) continue;
    one.update({{"ok", true}, {"kind", "parameter"}});
    return json_text(one);
  }
  refuse(unknown_name("parameter or signal", name, names));
}

std::string CtlRequests::save(const CtlSession& session, const std::string& preset, const Answer& answer) {
  Json json{{"ok", true}, {"file", instance_.configuration().file().string()}, {"saved", Json::array()}};
  if (answer.changes.empty() && preset.empty()) return json_text(json);
  const std::vector<PresetOverride> overridden = save_changes(instance_, port_, answer, session.who(), preset);
  for (const ParameterChange& change : answer.changes) json["saved"].push_back(change_json(change));
  if (!preset.empty()) json["preset"] = preset;
  json["overridden"] = Json::array();
  for (const PresetOverride& one : overridden)
    json["overridden"].push_back({{"name", one.name}, {"preset", one.preset}, {"value", one.value}});
  return json_text(json);
}

std::string CtlRequests::watch(CtlSession& session, const OrderRequest& request) {
  const SignalTable& table = instance_.catalog().signals;
  const double rate_hz = request.number("rate_hz", rate_usual_hz);
  std::vector<SignalId> ids;
  Json signals = Json::array();
  for (const Json& name : request.json["signals"]) {
    const auto id = table.find(name.get<std::string>());
    if (!id) refuse(unknown_name("signal", name.get<std::string>(), table.names()));
    ids.push_back(*id);
    signals.push_back({{"name", name}, {"unit", table.info(*id).unit}});
  }
  if (ids.empty()) refuse("watch what? \"signals\" is empty");
  session.watched = std::move(ids);
  const double every = 1 / (rate_hz * instance_.facts().control_period_s);
  session.every_ticks = static_cast<std::uint32_t>(std::max(1.0, std::round(std::min(every, 1e9))));
  session.next_tick = 0;
  watches_fast(session, session.every_ticks < row_every_ticks);
  return json_text({{"ok", true}, {"signals", std::move(signals)}});
}

void CtlRequests::watches_fast(const CtlSession& session, bool fast) {
  if (fast) fast_.insert(session.number());
  if (!fast) fast_.erase(session.number());
  port_.want_signals(fast_.empty() ? row_every_ticks : 1);
}

std::string CtlRequests::sample(CtlSession& session) {
  const auto row = port_.signals();
  if (row->values.empty() || row->tick < session.next_tick) return {};
  session.next_tick = row->tick + session.every_ticks;
  Json values = Json::array();
  for (const SignalId id : session.watched)
    values.push_back(std::isfinite(row->values[id]) ? Json(row->values[id]) : Json(nullptr));
  return json_text({{"tick", row->tick}, {"time_s", 1e-9 * static_cast<double>(row->time_ns)}, {"values", values}});
}

std::string CtlRequests::faults() {
  upkeep();
  const SafetyStatus& safety = port_.status().safety;
  Json all = Json::array();
  const auto json_of = [&](const Fault& fault) {
    return fault_json(fault, kadans::told(fault, instance_.facts().subjects, 0));
  };
  for (const auto& [key, seen] : faults_) {
    Json one = json_of(seen.last);
    one["count"] = seen.count;
    all.push_back(std::move(one));
  }
  Json json{{"ok", true}, {"level", name(safety.level)}, {"since_clearing", safety.fault_count}, {"faults", all}};
  if (safety.fault_count > 0) json["first"] = json_of(safety.first_fault);
  return json_text(json);
}

void CtlRequests::forget(const CtlSession& session) {
  if (session.order != 0) port_.withdraw(session.order);
  asked_.erase(session.number());
  readers_.erase(session.number());
  watches_fast(session, false);
  if (session.has_console) leaving_.push_back(session.number());
}

void CtlRequests::upkeep() {
  while (!leaving_.empty() && port_.send({.kind = Order::Kind::leave_console, .client = leaving_.back()}) != 0)
    leaving_.pop_back();
  for (Event event; port_.next(event);) {
  }
  for (Fault fault; port_.next(fault);) {
    Seen& seen = faults_[{fault.code, fault.joint, fault.robot}];
    ++seen.count;
    seen.last = fault;
  }
}

}  // namespace kadans
