#include "text_orders.h"

#include "config/json/foreign_json.h"
#include "kadans/signal/input_error.h"
#include "remote/order/order_json.h"

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

std::optional<std::string> TextOrders::take(std::string_view text) {
  if (text.size() > text_max_bytes)
    return answer_text("", "", false, "an order may have " + std::to_string(text_max_bytes) + " bytes");
  Asked asked;
  try {
    const Json json = parse_foreign_json(text);
    if (!json.is_object()) return answer_text("", "", false, "this is no JSON object");
    asked.id = id_of(json);
    const auto verb = json.find("verb");
    if (verb != json.end() && verb->is_string() && verb->get_ref<const std::string&>().size() <= verb_max_bytes)
      asked.verb = *verb;
    if (!p_.allowed) return answer_text(asked.id, asked.verb, false, p_.refusal);
    return obey(asked, read_brief_request(json, p_.pace != nullptr));
  } catch (const InputError& error) {
    return answer_text(asked.id, asked.verb, false, std::string("not understood: ") + error.what());
  }
}

std::optional<std::string> TextOrders::obey(Asked& asked, const OrderRequest& request) {
  if (!request.info->kind) {
    if (request.is("estop")) p_.instance.stop_now(p_.who);
    if (!request.is("estop")) p_.pace->obey(request);
    return answer_text(asked.id, asked.verb, true, "");
  }
  const std::uint64_t number = p_.port.send(request.order(p_.who));
  if (number == 0) return answer_text(asked.id, asked.verb, false, "too many orders wait");
  asked.save = request.is("save");
  asked.preset = request.text("preset");
  asked.asked_ns = clock_.now_ns();
  waiting_[number] = asked;
  return std::nullopt;
}

std::optional<std::string> TextOrders::next() {
  const std::int64_t now_ns = waiting_.empty() ? 0 : clock_.now_ns();
  for (const auto& [number, asked] : waiting_) {
    if (now_ns > asked.asked_ns + patience_ns) p_.port.withdraw(number);
  }
  for (Answer answer; p_.port.next(answer); answer = {}) {
    if (answer.number == report_) {
      report_ = 0;
      if (answer.done) behaviors_ = std::move(answer.behaviors);
      continue;
    }
    const auto found = waiting_.find(answer.number);
    if (found == waiting_.end()) continue;
    const Asked asked = std::move(found->second);
    waiting_.erase(found);
    if (asked.save && answer.done) answer = saved(p_.instance, p_.port, answer, p_.who, asked.preset);
    return answer_text(asked.id, asked.verb, answer.done, answer.text);
  }
  return std::nullopt;
}

void TextOrders::ask_behaviors() {
  if (report_ == 0) report_ = p_.port.send({.kind = Order::Kind::report, .who = p_.who});
}

}  // namespace kadans
