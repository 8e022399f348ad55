#include "kadans/remote/ros2/text_commands.h"

#include <exception>

#include "kadans/config/foreign_json.h"
#include "kadans/signal/input_error.h"
#include "live_protocol.h"

namespace kadans {
namespace {

constexpr std::size_t id_max_bytes = 256, verb_max_bytes = 64;

std::string answer_text(const std::string& id, const std::string& verb, bool done, const std::string& text) {
  Json json = Json::object();
  if (!id.empty()) json["id"] = parse_foreign_json(id);
  if (!verb.empty()) json["verb"] = verb;
  json["done"] = done;
  json["text"] = text;
  return json_text(json);
}

// A number or a short text, as it came; else none.
std::string id_of(const Json& json) {
  const auto id = json.find("id");
  if (id == json.end() || !(id->is_number() || id->is_string())) return "";
  const std::string text = json_text(*id);
  return text.size() <= id_max_bytes ? text : "";
}

}  // namespace

std::optional<std::string> TextCommands::take(std::string_view text) {
  if (text.size() > text_max_bytes)
    return answer_text("", "", false, "an order may have " + std::to_string(text_max_bytes) + " bytes");
  Asked asked;
  try {
    const Json json = parse_foreign_json(text);
    if (!json.is_object()) return answer_text("", "", false, "this is no JSON object");
    asked.id = id_of(json);
    const std::string verb = json.at("verb");
    if (verb.size() > verb_max_bytes) return answer_text(asked.id, "", false, "there is no verb as long as this");
    asked.verb = verb;
    return obey(asked, json.value("text", ""), json.value("value", 0.0));
  } catch (const InputError& error) {
    return answer_text(asked.id, asked.verb, false, std::string("not understood: ") + error.what());
  } catch (const nlohmann::json::exception& error) {  // a field is missing or of another type
    return answer_text(asked.id, asked.verb, false, std::string("not understood: ") + error.what());
  }
}

std::optional<std::string> TextCommands::obey(const Asked& asked, const std::string& text, double value) {
  const auto refused = [&](const std::string& why) { return answer_text(asked.id, asked.verb, false, why); };
  if (!p_.allowed) return refused(p_.refusal);
  if (asked.verb == "estop") {
    p_.instance.stop_now(p_.who);
    return answer_text(asked.id, asked.verb, true, "");
  }
  const std::optional<Order::Kind> kind = order_of(asked.verb);
  if (!kind) {
    if (p_.pace != nullptr && p_.pace->obey(asked.verb, text, value))
      return answer_text(asked.id, asked.verb, true, "");
    return refused("'" + asked.verb + "' is no order; there are " + verbs_text(p_.pace != nullptr));
  }
  const std::uint64_t number = p_.port.send({.kind = *kind, .text = text, .value = value, .who = p_.who});
  if (number == 0) return refused("too many orders wait");
  waiting_[number] = asked;
  waiting_[number].save = *kind == Order::Kind::changes;
  waiting_[number].asked_ns = clock_.now_ns();
  return std::nullopt;
}

std::optional<std::string> TextCommands::next() {
  const std::int64_t now_ns = waiting_.empty() ? 0 : clock_.now_ns();
  for (const auto& [number, asked] : waiting_) {
    if (now_ns > asked.asked_ns + patience_ns) p_.port.withdraw(number);
  }
  for (Answer answer; p_.port.next(answer); answer = {}) {
    const auto found = waiting_.find(answer.number);
    if (found == waiting_.end()) continue;
    const Asked asked = std::move(found->second);
    waiting_.erase(found);
    bool done = answer.done;
    std::string text = answer.text;
    if (asked.save && done) save(answer, done, text);
    return answer_text(asked.id, asked.verb, done, text);
  }
  return std::nullopt;
}

void TextCommands::save(const Answer& answer, bool& done, std::string& text) {
  try {
    ConfigurationText& configuration = p_.instance.configuration();
    const auto overridden = configuration.save(answer.changes, p_.instance.catalog());
    (void)p_.port.send({.kind = Order::Kind::saved, .changes = answer.changes});
    text = configuration.told(answer.changes.size(), overridden);
  } catch (const std::exception& error) {
    done = false;
    text = error.what();
  }
}

}  // namespace kadans
