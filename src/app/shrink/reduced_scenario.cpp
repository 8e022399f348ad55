#include "reduced_scenario.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <limits>
#include <numbers>

#include "config/json/json_layout.h"
#include "config/robot/project_root.h"
#include "config/scenario/based_on.h"
#include "kadans/signal/nearest_name.h"
#include "signal/number_text.h"

namespace kadans {
namespace {

namespace fs = std::filesystem;
using Kind = JsonValue::Kind;

const JsonValue* value_in(const JsonValue& object, std::string_view name) {
  const JsonMember* member = object.find(name);
  return member == nullptr ? nullptr : &member->value;
}
std::string text_in(const JsonValue& object, std::string_view name) {
  const JsonValue* value = value_in(object, name);
  return value == nullptr ? "" : value->text;
}
double number_at(const JsonValue& object, std::string_view name, double otherwise) {
  const JsonValue* value = value_in(object, name);
  return value == nullptr ? otherwise : value->number;
}

// The list of a robot, or of the scenario: the faults of its bus stand in an object of their own.
JsonValue* list_in(JsonValue& robot, const std::string& list) {
  const auto find = [](JsonValue& object, std::string_view name) -> JsonValue* {
    const auto found = std::ranges::find(object.members, name, &JsonMember::name);
    return found == object.members.end() ? nullptr : &found->value;
  };
  if (list != "bus") return find(robot, list);
  JsonValue* const bus = find(robot, "bus");
  return bus == nullptr ? nullptr : find(*bus, "faults");
}

double impulse_of(const JsonValue& push) {
  const JsonValue* impulse = value_in(push, "impulse_Ns");
  const JsonValue* force = value_in(push, "force_N");
  if (impulse == nullptr && force == nullptr) return 0;
  double square = 0;
  for (const JsonValue& part : (impulse != nullptr ? impulse : force)->items) square += part.number * part.number;
  const double mean = text_in(push, "shape") == "half_sine" ? 2 / std::numbers::pi : 1;
  return std::sqrt(square) * (impulse != nullptr ? 1 : mean * number_at(push, "duration_s", 0.1));
}

// What the merged file says differently: nothing when it cannot be said in a file that is based on the other one.
std::optional<JsonValue> difference(const JsonValue& base, const JsonValue& other);

std::optional<JsonValue> members_apart(const JsonValue& base, const JsonValue& other) {
  JsonValue apart;
  apart.kind = Kind::object;
  for (const JsonMember& member : base.members) {
    const JsonValue* const now = value_in(other, member.name);
    if (now == nullptr && member.value.kind != Kind::array) return std::nullopt;
    if (now == nullptr) {
      member_of(apart, member.name) = json_list({});
    } else if (laid_out(member.value) != laid_out(*now)) {
      auto inner = difference(member.value, *now);
      if (!inner) return std::nullopt;
      member_of(apart, member.name) = std::move(*inner);
    }
  }
  for (const JsonMember& member : other.members) {
    if (base.find(member.name) == nullptr) apart.members.push_back(member);
  }
  return apart;
}

std::optional<JsonValue> difference(const JsonValue& base, const JsonValue& other) {
  if (base.kind == Kind::object && other.kind == Kind::object) return members_apart(base, other);
  const bool named =
      base.kind == Kind::array && other.kind == Kind::array && base.items.size() == other.items.size() &&
      std::ranges::all_of(base.items, [](const JsonValue& item) { return item.find("name") != nullptr; });
  if (!named) return other;
  std::vector<JsonValue> items;
  for (std::size_t i = 0; i < base.items.size(); ++i) {
    auto apart = members_apart(base.items[i], other.items[i]);
    if (!apart) return std::nullopt;
    if (apart->members.empty()) continue;
    apart->members.insert(apart->members.begin(), *other.items[i].find("name"));
    items.push_back(std::move(*apart));
  }
  return json_list(std::move(items));
}

}  // namespace

ReducedScenario::ReducedScenario(JsonValue scenario, std::string file)
    : whole_(std::move(scenario)), file_(std::move(file)) {
  erase_member(whole_, "based_on");
  find_disturbances(whole_, "");
  find_entries(whole_, "");
  if (const JsonValue* const bus = value_in(whole_, "bus")) {
    const JsonValue* const faults = value_in(*bus, "faults");
    for (std::size_t i = 0; faults != nullptr && i < faults->items.size(); ++i)
      disturbances_.push_back({.robot = {}, .list = "bus", .index = i});
  }
  const JsonValue* const robots = value_in(whole_, "robots");
  if (robots == nullptr) return;
  for (const JsonValue& robot : robots->items) {
    find_disturbances(robot, text_in(robot, "name"));
    find_entries(robot, text_in(robot, "name"));
  }
}

void ReducedScenario::find_disturbances(const JsonValue& robot, const std::string& name) {
  for (const std::string list : {"pushes", "faults", "events"}) {
    const JsonValue* const items = value_in(robot, list);
    for (std::size_t i = 0; items != nullptr && i < items->items.size(); ++i) {
      const JsonValue& item = items->items[i];
      Disturbance one{.robot = name, .list = list, .index = i};
      if (list == "pushes") one.impulse_Ns = impulse_of(item);
      one.from_s = number_at(item, list == "faults" ? "from_s" : "at_s", 0);
      // Missed ticks without an end come once, with one again and again.
      if (list == "faults" && text_in(item, "kind") != "clock_missed")
        one.until_s = number_at(item, "until_s", std::numeric_limits<double>::infinity());
      disturbances_.push_back(std::move(one));
    }
  }
}

void ReducedScenario::find_entries(const JsonValue& robot, const std::string& name) {
  for (const char* const list : {"set", "randomise"}) {
    const JsonValue* const entries = value_in(robot, list);
    if (entries == nullptr) continue;
    for (const JsonMember& member : entries->members) {
      if (member.name != "doc") entries_.push_back({name, member.name});
    }
  }
}

void ReducedScenario::choose(std::optional<std::uint64_t> seed, const std::string& play) {
  JsonValue number;
  number.kind = Kind::number;
  if (seed) {
    number.text = std::to_string(*seed);
    member_of(whole_, "seed") = std::move(number);
  }
  if (!play.empty()) member_of(whole_, "behaviors") = json_list({json_string(play)});
}

std::string ReducedScenario::seed() const { return text_in(whole_, "seed"); }
double ReducedScenario::duration_s() const noexcept { return number_at(whole_, "duration_s", 0); }

void ReducedScenario::take_quantities(const std::vector<QuantityValue>& values, const std::vector<std::string>& set) {
  for (const std::string& setting : set) entries_.push_back({"", setting.substr(0, setting.find('='))});
  for (const QuantityValue& value : values) {
    std::optional<VariedQuantity> found;
    for (std::size_t i = 0; i < entries_.size(); ++i) {  // the last one that chooses it has set it
      const std::string prefix = entries_[i].robot.empty() ? "" : entries_[i].robot + ".";
      if (value.name.starts_with(prefix) && matches(entries_[i].pattern, value.name.substr(prefix.size())))
        found = VariedQuantity{entries_[i].robot, value.name.substr(prefix.size()), value.value, i};
    }
    if (!found) continue;
    const auto known = std::ranges::find_if(
        quantities_, [&](const VariedQuantity& one) { return one.robot == found->robot && one.name == found->name; });
    if (known != quantities_.end()) quantities_.erase(known);
    quantities_.push_back(std::move(*found));
  }
}

Reduction ReducedScenario::all() const {
  return {.disturbances = std::vector<bool>(disturbances_.size(), true),
          .quantities = std::vector<bool>(quantities_.size(), true),
          .share = std::vector<double>(disturbances_.size(), 1),
          .until_s = std::vector<std::optional<double>>(disturbances_.size()),
          .duration_s = duration_s()};
}

JsonValue ReducedScenario::reduced(const Reduction& reduction) const {
  JsonValue tree = whole_;
  erase_member(tree, "tags");
  if (!reduction.seeded) erase_member(tree, "seed");
  if (reduction.duration_s != duration_s()) member_of(tree, "duration_s") = json_number(reduction.duration_s);
  reduce_robot("", reduction, tree);
  if (tree.find("robots") != nullptr) {
    for (JsonValue& robot : member_of(tree, "robots").items) reduce_robot(text_in(robot, "name"), reduction, robot);
  }
  std::stable_partition(tree.members.begin(), tree.members.end(),
                        [](const JsonMember& member) { return member.name != "checks"; });
  return tree;
}

void ReducedScenario::reduce_robot(const std::string& name, const Reduction& reduction, JsonValue& robot) const {
  for (std::size_t at = disturbances_.size(); at-- > 0;) {  // the last first, so that the others keep their places
    const Disturbance& one = disturbances_[at];
    if (one.robot != name) continue;
    std::vector<JsonValue>& items = list_in(robot, one.list)->items;
    if (reduction.disturbances[at]) {
      reduce_item(at, reduction, items[one.index]);
    } else {
      items.erase(items.begin() + static_cast<std::ptrdiff_t>(one.index));
    }
  }
  for (const char* const list : {"pushes", "faults", "events"}) {
    if (const JsonValue* const items = list_in(robot, list); items != nullptr && items->items.empty())
      erase_member(robot, list);
  }
  erase_member(robot, "randomise");
  JsonValue set = set_of(name, reduction);
  if (set.members.empty()) {
    erase_member(robot, "set");
  } else {
    member_of(robot, "set") = std::move(set);
  }
}

void ReducedScenario::reduce_item(std::size_t at, const Reduction& reduction, JsonValue& item) const {
  if (reduction.until_s[at]) member_of(item, "until_s") = json_number(*reduction.until_s[at]);
  if (reduction.share[at] == 1) return;
  for (const char* const key : {"impulse_Ns", "force_N"}) {
    if (item.find(key) == nullptr) continue;
    for (JsonValue& part : member_of(item, key).items)
      part = json_number(with_digits(part.number * reduction.share[at], 4));
  }
}

// A pattern stays one where all that it chose is left, with one value.
JsonValue ReducedScenario::set_of(const std::string& robot, const Reduction& reduction) const {
  JsonValue set;
  set.kind = Kind::object;
  for (std::size_t entry = 0; entry < entries_.size(); ++entry) {
    std::vector<const VariedQuantity*> left;
    bool one_value = true;
    for (std::size_t i = 0; i < quantities_.size(); ++i) {
      if (quantities_[i].entry != entry) continue;
      one_value = one_value && reduction.quantities[i] && (left.empty() || left[0]->value == quantities_[i].value);
      if (reduction.quantities[i]) left.push_back(&quantities_[i]);
    }
    if (left.empty() || entries_[entry].robot != robot) continue;
    if (one_value) left.resize(1);
    for (const VariedQuantity* one : left) {
      member_of(set, one_value ? entries_[entry].pattern : one->name) =
          json_number(with_digits(one->value, reduction.digits));
    }
  }
  return set;
}

void ReducedScenario::keep_one_check(JsonValue& tree) const {
  if (tree.find("checks") == nullptr) return;
  std::erase_if(member_of(tree, "checks").items,
                [&](const JsonValue& check) { return text_in(check, "name") != check_; });
}

// Paths to the schema start at the file's folder.
void ReducedScenario::describe(const std::string& out, const std::string& doc, JsonValue& tree) const {
  member_of(tree, "name") = json_string(fs::path(out).stem().string());
  erase_member(tree, "doc");
  const auto name = std::ranges::find(tree.members, "name", &JsonMember::name);
  tree.members.insert(name + 1, JsonMember{.name = "doc", .place = {}, .value = json_string(doc)});
  const std::string schema = text_in(whole_, "$schema");
  if (schema.empty() || fs::path(schema).is_absolute()) return;
  const fs::path from = fs::absolute(file_).parent_path() / schema, to = fs::absolute(out).lexically_normal();
  member_of(tree, "$schema") =
      json_string(from.lexically_normal().lexically_proximate(to.parent_path()).generic_string());
}

std::string ReducedScenario::text(const Reduction& reduction) const {
  JsonValue tree = reduced(reduction);
  keep_one_check(tree);
  return laid_out(tree);
}

std::string ReducedScenario::text(const Reduction& reduction, const std::string& out, const std::string& doc) const {
  JsonValue tree = reduced(reduction);
  keep_one_check(tree);
  erase_member(tree, "repeat");
  describe(out, doc, tree);
  return laid_out(tree);
}

std::optional<std::string> ReducedScenario::based_text(const Reduction& reduction, const std::string& out,
                                                       const std::string& doc) const {
  JsonValue tree = reduced(reduction);
  for (const char* const key : {"seed", "repeat"}) {  // a file that is based on another cannot leave them out
    if (whole_.find(key) != nullptr && (key == std::string("repeat") || tree.find(key) == nullptr))
      member_of(tree, key) = json_number(1);
  }
  describe(out, doc, tree);
  JsonValue base = parse_based_json(read_input_file(file_), file_).value;
  erase_member(base, "based_on");
  std::optional<JsonValue> apart = difference(base, tree);
  if (!apart) return std::nullopt;
  JsonValue text;
  text.kind = Kind::object;
  if (tree.find("$schema") != nullptr) member_of(text, "$schema") = member_of(tree, "$schema");
  const fs::path from_root = fs::absolute(file_).lexically_normal().lexically_proximate(project_root(out));
  member_of(text, "based_on") = json_string(from_root.generic_string());
  for (const JsonMember& member : tree.members) {  // in its order
    if (member.name != "$schema" && apart->find(member.name) != nullptr)
      text.members.push_back(*apart->find(member.name));
  }
  for (const JsonMember& member : apart->members) {
    if (text.find(member.name) == nullptr) text.members.push_back(member);
  }
  return laid_out(text);
}

std::vector<std::string> ReducedScenario::told(const Reduction& reduction) const {
  std::vector<std::string> all;
  for (std::size_t at = 0; at < disturbances_.size(); ++at) {
    if (reduction.disturbances[at]) all.push_back(told(at, reduction));
  }
  std::vector<std::string> robots{""};
  for (const Entry& entry : entries_) {
    if (std::ranges::find(robots, entry.robot) == robots.end()) robots.push_back(entry.robot);
  }
  for (const std::string& robot : robots) {
    for (const JsonMember& member : set_of(robot, reduction).members)
      all.push_back((robot.empty() ? "" : robot + ".") + member.name + " = " + member.value.text);
  }
  return all;
}

std::string ReducedScenario::told(std::size_t at, const Reduction& reduction) const {
  const Disturbance& one = disturbances_[at];
  JsonValue tree = whole_;
  JsonValue* robot = &tree;
  if (!one.robot.empty()) {
    robot = &*std::ranges::find_if(member_of(tree, "robots").items,
                                   [&](const JsonValue& item) { return text_in(item, "name") == one.robot; });
  }
  JsonValue& item = list_in(*robot, one.list)->items[one.index];
  if (one.list == "bus") return item.text + " on the bus";
  reduce_item(at, reduction, item);
  const std::string of = one.robot.empty() ? "" : " of " + one.robot;
  const std::string at_s = " at " + number_text(one.from_s) + " s";
  if (one.is_push()) return printed("a push of %.4g Ns on ", impulse_of(item)) + text_in(item, "link") + of + at_s;
  if (one.list == "events") {
    const std::string what = text_in(item, "list") + text_in(item, "event") + text_in(item, "behavior");
    return "the event '" + text_in(item, "do") + (what.empty() ? "" : " " + what) + "'" + of + at_s;
  }
  const double until_s = number_at(item, "until_s", HUGE_VAL);
  const std::string where = text_in(item, "of").empty() ? "" : " of " + text_in(item, "of");
  return "the fault " + text_in(item, "kind") + where + of + " from " + number_text(one.from_s) + " s" +
         (std::isfinite(until_s) ? " to " + number_text(until_s) + " s" : " on");
}

}  // namespace kadans
