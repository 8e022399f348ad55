#include "urdf_grammar.h"

#include <algorithm>
#include <map>
#include <set>

#include "kadans/signal/nearest_name.h"
#include "urdf_value.h"

namespace kadans {
namespace {

using tinyxml2::XMLAttribute;
using tinyxml2::XMLElement;

struct AttributeRule {
  std::string name;
  UrdfValue value = UrdfValue::text;
  bool required = false;
};

struct ChildRule {
  std::string name;
  int least = 0, most = 1;
};

struct ElementRule {
  std::string name;
  std::vector<AttributeRule> attributes;
  std::vector<ChildRule> children;
};

constexpr int any = 1000000;
constexpr bool required = true;

std::vector<ElementRule> link_rules() {
  using enum UrdfValue;
  return {
      {"robot",
       {{"name", name, required}, {"version", text}},
       {{"link", 0, any}, {"joint", 0, any}, {"material", 0, any}}},
      {"link", {{"name", name, required}}, {{"inertial"}, {"visual", 0, any}, {"collision", 0, any}}},
      {"inertial", {}, {{"origin"}, {"mass", 1}, {"inertia", 1}}},
      {"origin", {{"xyz", vector}, {"rpy", vector}}, {}},
      {"mass", {{"value", positive, required}}, {}},
      {"inertia",
       {{"ixx", number, required},
        {"iyy", number, required},
        {"izz", number, required},
        {"ixy", number, required},
        {"ixz", number, required},
        {"iyz", number, required}},
       {}},
      {"visual", {{"name", name}}, {{"origin"}, {"geometry", 1}, {"material"}}},
      {"collision", {{"name", name}}, {{"origin"}, {"geometry", 1}}},
      {"geometry", {}, {{"box", 0, any}, {"sphere", 0, any}, {"cylinder", 0, any}, {"mesh", 0, any}}},
      {"box", {{"size", positive_vector, required}}, {}},
      {"sphere", {{"radius", positive, required}}, {}},
      {"cylinder", {{"radius", positive, required}, {"length", positive, required}}, {}},
      {"mesh", {{"filename", name, required}, {"scale", scale}}, {}},
      {"material", {{"name", name, required}}, {{"color"}, {"texture"}}},
      {"color", {{"rgba", color, required}}, {}},
      {"texture", {{"filename", name, required}}, {}},
  };
}

std::vector<ElementRule> joint_rules() {
  using enum UrdfValue;
  return {
      {"joint",
       {{"name", name, required}, {"type", name, required}},
       {{"origin"},
        {"parent", 1},
        {"child", 1},
        {"axis"},
        {"limit"},
        {"dynamics"},
        {"mimic"},
        {"safety_controller"},
        {"calibration"}}},
      {"parent", {{"link", name, required}}, {}},
      {"child", {{"link", name, required}}, {}},
      {"axis", {{"xyz", vector, required}}, {}},
      {"limit",
       {{"lower", number}, {"upper", number}, {"effort", not_negative, required}, {"velocity", not_negative, required}},
       {}},
      {"dynamics", {{"damping", not_negative}, {"friction", not_negative}}, {}},
      {"mimic", {{"joint", name, required}, {"multiplier", number}, {"offset", number}}, {}},
      {"safety_controller",
       {{"soft_lower_limit", number},
        {"soft_upper_limit", number},
        {"k_position", number},
        {"k_velocity", number, required}},
       {}},
      {"calibration", {{"rising", number}, {"falling", number}, {"reference_position", number}}, {}},
  };
}

const ElementRule* rule_of(std::string_view element) {
  static const std::map<std::string, ElementRule, std::less<>> rules = [] {
    std::map<std::string, ElementRule, std::less<>> all;
    for (const auto& group : {link_rules(), joint_rules()}) {
      for (const ElementRule& rule : group) all.emplace(rule.name, rule);
    }
    return all;
  }();
  const auto found = rules.find(element);
  return found == rules.end() ? nullptr : &found->second;
}

template <typename Rule>
const Rule* find_rule(const std::vector<Rule>& rules, std::string_view name) {
  const auto found = std::find_if(rules.begin(), rules.end(), [&](const Rule& rule) { return rule.name == name; });
  return found == rules.end() ? nullptr : &*found;
}

// ", did you mean 'mass'?" or, with nothing near, what there is to choose from.
std::string hint(const std::string& nearest, const std::vector<std::string>& known) {
  if (!nearest.empty()) return ", did you mean '" + nearest + "'?";
  std::string list;
  for (const std::string& name : known) list += (list.empty() ? "; known are: " : ", ") + name;
  return list.empty() ? "; it has none" : list;
}

bool of_others(std::string_view name) { return name.find(':') != std::string_view::npos; }

std::string bracketed(const XMLElement& element) { return "<" + shown(element.Name()) + ">"; }

// Each of these returns the known name that an unknown one comes near to, so that it is not reported as missing too.
std::string refuse_unknown_attribute(UrdfDocument& document, const XMLElement& element, const XMLAttribute& attribute,
                                     const ElementRule& rule) {
  const std::string_view name = attribute.Name();
  if (of_others(name) || name == "xmlns") return {};
  const std::vector<std::string> known = names_of(rule.attributes);
  std::string nearest = nearest_name(name, known);
  document.refuse_name(element, name,
                       "unknown attribute '" + shown(name) + "' of " + bracketed(element) + hint(nearest, known));
  return nearest;
}

std::string refuse_unknown_child(UrdfDocument& document, const XMLElement& child, const ElementRule& rule) {
  if (of_others(child.Name())) return {};
  const std::vector<std::string> known = names_of(rule.children);
  std::string nearest = nearest_name(child.Name(), known);
  if (rule.name == "robot" && nearest.empty()) return {};
  const std::string what = rule.name == "geometry" ? "unknown geometry " + bracketed(child)
                                                   : "unknown element " + bracketed(child) + " in <" + rule.name + ">";
  document.refuse(child, what + hint(nearest, known));
  return nearest;
}

void check_attributes(UrdfDocument& document, const XMLElement& element, const ElementRule& rule) {
  std::set<std::string, std::less<>> misspelt;
  for (const XMLAttribute* a = element.FirstAttribute(); a != nullptr; a = a->Next()) {
    const AttributeRule* known = find_rule(rule.attributes, a->Name());
    if (known == nullptr) {
      misspelt.insert(refuse_unknown_attribute(document, element, *a, rule));
    } else if (const auto defect = value_defect(known->value, a->Value())) {
      document.refuse_value(element, a->Name(),
                            bracketed(element) + " " + known->name + " '" + shown(a->Value()) + "' " + *defect);
    }
  }
  for (const AttributeRule& wanted : rule.attributes) {
    if (!wanted.required || element.Attribute(wanted.name.c_str()) != nullptr || misspelt.contains(wanted.name))
      continue;
    document.refuse(element, bracketed(element) + " has no attribute '" + wanted.name + "'");
  }
}

void check_element(UrdfDocument& document, const XMLElement& element, const ElementRule& rule) {
  check_attributes(document, element, rule);
  if (document.has_text(element)) document.refuse_text(element, "text in " + bracketed(element) + ", which has none");
  std::map<std::string, int, std::less<>> seen;
  for (const XMLElement* child = element.FirstChildElement(); child != nullptr; child = child->NextSiblingElement()) {
    const ChildRule* known = find_rule(rule.children, child->Name());
    if (known == nullptr) {
      ++seen[refuse_unknown_child(document, *child, rule)];
      continue;
    }
    if (++seen[known->name] == known->most + 1) {
      document.refuse(*child, "a second " + bracketed(*child) + " in " + bracketed(element));
    }
    check_element(document, *child, *rule_of(child->Name()));
  }
  for (const ChildRule& wanted : rule.children) {
    if (seen[wanted.name] >= wanted.least) continue;
    document.refuse(element, bracketed(element) + " has no <" + wanted.name + ">");
  }
}

void find_xacro(UrdfDocument& document, const XMLElement& element) {
  const std::string advice = ": this is xacro, expand it first (xacro FILE.xacro > FILE.urdf)";
  if (std::string_view(element.Name()).starts_with("xacro:")) document.refuse(element, bracketed(element) + advice);
  for (const XMLAttribute* a = element.FirstAttribute(); a != nullptr; a = a->Next()) {
    const std::string_view value = a->Value();
    if (std::string_view(a->Name()) == "xmlns:xacro") {
      document.refuse_name(element, a->Name(), "xmlns:xacro" + advice + "; if it is expanded, remove this attribute");
    } else if (value.find("${") != std::string_view::npos || value.find("$(") != std::string_view::npos) {
      document.refuse_value(element, a->Name(), "'" + shown(value) + "'" + advice);
    }
  }
  for (const XMLElement* child = element.FirstChildElement(); child != nullptr; child = child->NextSiblingElement()) {
    if (&element != &document.robot() || find_rule(rule_of("robot")->children, child->Name()) != nullptr ||
        std::string_view(child->Name()).starts_with("xacro:")) {
      find_xacro(document, *child);
    }
  }
}

}  // namespace

void check_xacro(UrdfDocument& document) {
  find_xacro(document, document.robot());
  document.throw_if_refused();
}

void check_grammar(UrdfDocument& document) {
  const XMLElement& robot = document.robot();
  if (std::string_view(robot.Name()) != "robot") {
    document.refuse(robot, "the root element is " + bracketed(robot) + ", a URDF's is <robot>");
    document.throw_if_refused();
  }
  check_element(document, robot, *rule_of("robot"));
  const std::string version = attribute_or_empty(robot, "version");
  if (robot.Attribute("version") != nullptr && version != "1.0") {
    document.refuse_value(robot, "version", "URDF version '" + shown(version) + "' is not known, only '1.0'");
  }
}

bool known_attribute(std::string_view element, std::string_view attribute) {
  const ElementRule* rule = rule_of(element);
  return rule != nullptr && find_rule(rule->attributes, attribute) != nullptr;
}

bool known_child(std::string_view element, std::string_view child) {
  const ElementRule* rule = rule_of(element);
  return rule != nullptr && find_rule(rule->children, child) != nullptr;
}

}  // namespace kadans
