#include "order_request.h"

#include <algorithm>

#include "config/json/fields.h"
#include "config/json/foreign_json.h"
#include "config/json/problems.h"

namespace kadans {
namespace {

using enum OrderArgument::Kind;

[[noreturn]] void fail(const std::string& why) { throw InputError({.message = why}); }

// As it is shown to whoever said it.
std::string shown(const std::string& verb) { return "'" + verb.substr(0, 64) + "'"; }

bool fits(const Json& value, OrderArgument::Kind kind) {
  switch (kind) {
    case text:
      return value.is_string();
    case number:
      return value.is_number();
    case flag:
      return value.is_boolean();
    case texts:
      return value.is_array() && std::ranges::all_of(value, [](const Json& one) { return one.is_string(); });
    case none:
      break;
  }
  return false;
}

const char* kind_text(OrderArgument::Kind kind) {
  switch (kind) {
    case number:
      return "a number";
    case flag:
      return "true or false";
    case texts:
      return "an array of strings";
    default:
      return "a string";
  }
}

const OrderInfo& order_named(const std::string& verb) {
  if (const OrderInfo* found = find_order(verb)) return *found;
  std::vector<std::string> verbs;
  for (const OrderInfo& order : order_table()) verbs.emplace_back(order.verb);
  fail(unknown_name("verb", verb, verbs));
}

// `called`: what the client calls it.
void check_argument(const OrderInfo& order, const OrderArgument& argument, const char* called, const Json& json) {
  const auto given = json.find(argument.name);
  const std::string quoted = "\"" + std::string(called) + "\"";
  if (given == json.end()) {
    if (argument.required) fail(std::string(order.verb) + " needs " + quoted);
    return;
  }
  if (!fits(*given, argument.kind)) fail(quoted + " must be " + kind_text(argument.kind));
  if (argument.kind == text && argument.required && given->get_ref<const std::string&>().empty())
    fail(std::string(order.verb) + " needs " + quoted);
  if (argument.kind != number) return;
  const double value = given->get<double>();
  if (value >= argument.min && value <= argument.max) return;
  const bool bounded = argument.max < std::numeric_limits<double>::max();
  fail(quoted + " = " + number_text(value) + " must be " +
       (bounded ? number_text(argument.min) + ".." + number_text(argument.max)
                : "at least " + number_text(argument.min)));
}

// A field that is not known could be the name of joints, without which an order is about all of them.
void check_names(const OrderInfo& order, const Json& json, const std::vector<std::string>& known) {
  for (const auto& [key, value] : json.items()) {
    if (std::ranges::find(known, key) == known.end())
      fail(unknown_name("field", key, known, std::string("of ") + order.verb));
  }
}

const std::string& verb_in(const Json& json) {
  const auto verb = json.find("verb");
  if (verb == json.end() || !verb->is_string()) fail("a request needs \"verb\", a string");
  return verb->get_ref<const std::string&>();
}

}  // namespace

Order OrderRequest::order(const std::string& who, std::uint64_t client) const {
  Order order{.kind = *info->kind, .who = who, .client = client};
  if (json.value("replace", false)) order.kind = Order::Kind::replace;
  if (const OrderArgument* of = info->argument(OrderArgument::Kind::text)) order.text = text(of->name);
  if (const OrderArgument* of = info->argument(OrderArgument::Kind::number)) order.value = number(of->name, 0);
  return order;
}

OrderRequest read_request(std::string_view line, Role role) {
  std::optional<Json> json = read_foreign_json(line);
  if (!json || !json->is_object()) fail("this is no JSON object on one line");
  OrderRequest request{&order_named(verb_in(*json)), std::move(*json)};
  const OrderInfo& order = *request.info;
  std::vector<std::string> known{"verb"};
  for (const OrderArgument& argument : order.arguments) {
    if (argument.kind == none) continue;
    check_argument(order, argument, argument.name, request.json);
    known.emplace_back(argument.name);
  }
  check_names(order, request.json, known);
  if (order.faces == OrderInfo::Faces::paced) fail(std::string("'") + order.verb + "' is for the page and ROS 2");
  if (order.role > role)
    fail(std::string("'") + order.verb + "' needs the role " + name(order.role) + "; this socket gives " + name(role));
  return request;
}

OrderRequest read_brief_request(const Json& json, bool paced) {
  const std::string& verb = verb_in(json);
  const OrderInfo* const info = find_order(verb);
  if (info == nullptr || !info->is_brief() || (info->faces == OrderInfo::Faces::paced && !paced))
    fail(shown(verb) + " is no order; there are " + brief_verbs(paced));
  check_names(*info, json, {"verb", "id", "text", "value"});
  OrderRequest request{info};
  for (const auto& [kind, field] : {std::pair{text, "text"}, {number, "value"}}) {
    const auto given = json.find(field);
    if (given != json.end() && !fits(*given, kind)) fail("\"" + std::string(field) + "\" must be " + kind_text(kind));
    const OrderArgument* const argument = info->argument(kind);
    const bool said = given != json.end() && *given != (kind == text ? Json("") : Json(0));
    if (argument == nullptr) {
      if (said) fail(std::string(verb) + " takes no \"" + field + "\"");
      continue;
    }
    if (said || (given != json.end() && kind == number)) request.json[argument->name] = *given;
    check_argument(*info, *argument, field, request.json);
  }
  return request;
}

std::vector<PresetOverride> save_changes(Instance& instance, InstancePort& port, const Answer& answer,
                                         const std::string& who, const std::string& preset) {
  const std::vector<PresetOverride> overridden =
      instance.configuration().save(answer.changes, instance.catalog(), {.preset = preset, .values = answer.set});
  (void)port.send({.kind = Order::Kind::saved, .who = who, .changes = answer.changes});
  return overridden;
}

}  // namespace kadans
