#include "mjcf_values.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "kadans/model/kinematics.h"
#include "model/xml_scan.h"

namespace kadans {
namespace {

// All actuators share their defaults: <motor> and <general> are ways to write one thing.
std::string_view kind_of(std::string_view element) {
  constexpr std::string_view actuators[] = {"motor",  "position", "velocity", "intvelocity",
                                            "damper", "cylinder", "muscle"};
  return std::ranges::find(actuators, element) == std::end(actuators) ? element : "general";
}

Quat of_columns(const Vec3& x, const Vec3& y, const Vec3& z) {
  const double w = 1 + x[0] + y[1] + z[2];
  if (w > 1e-6) return normalized({w, y[2] - z[1], z[0] - x[2], x[1] - y[0]});
  if (x[0] >= y[1] && x[0] >= z[2]) return normalized({y[2] - z[1], 1 + x[0] - y[1] - z[2], x[1] + y[0], z[0] + x[2]});
  if (y[1] >= z[2]) return normalized({z[0] - x[2], x[1] + y[0], 1 + y[1] - x[0] - z[2], y[2] + z[1]});
  return normalized({x[1] - y[0], z[0] + x[2], y[2] + z[1], 1 + z[2] - x[0] - y[1]});
}

}  // namespace

Vec3 unit(const Vec3& v) noexcept {
  const double n = length(v);
  return n > 0 ? Vec3{v[0] / n, v[1] / n, v[2] / n} : Vec3{0, 0, 1};
}

Quat z_to(const Vec3& direction) noexcept {
  const Vec3 to = unit(direction);
  const Vec3 axis = cross({0, 0, 1}, to);
  const double sine = length(axis);
  if (sine < 1e-12) return to[2] > 0 ? Quat{1, 0, 0, 0} : Quat{0, 1, 0, 0};
  return from_axis_angle(unit(axis), std::atan2(sine, to[2]));
}

void MjcfDefaults::read(const tinyxml2::XMLElement& element, const std::string& name) {
  const char* const given = element.Attribute("class");
  const std::string own = given == nullptr ? name : given;
  if (own != name) classes_[own] = classes_[name];  // what is not said otherwise is the parent's
  // Nested classes come after what their parent says, wherever they stand.
  for (const auto* child = element.FirstChildElement(); child != nullptr; child = child->NextSiblingElement()) {
    if (std::string_view(child->Name()) == "default") continue;
    Attributes& attributes = classes_[own][std::string(kind_of(child->Name()))];
    for (const XmlAttribute& attribute : UrdfDocument::tag(*child).attributes)
      attributes[std::string(attribute.name)] = {child->Attribute(std::string(attribute.name).c_str()),
                                                 attribute.value_at};
  }
  each_child(element, "default", [&](const tinyxml2::XMLElement& child) {
    if (child.Attribute("class") != nullptr) return read(child, own);
    document_.refuse(tag_at(child), "a <default> in another one needs a class");
  });
}

void MjcfDefaults::read(const tinyxml2::XMLElement& element) {
  read(element, "main");
  // The class of a first <default> is everybody's, whatever its name is.
  if (const char* const name = element.Attribute("class"); name != nullptr) classes_["main"] = classes_[name];
}

const MjcfValue* MjcfDefaults::find(const std::string& of_class, const std::string& element,
                                    const std::string& attribute) const {
  const auto in_class = classes_.find(of_class);
  if (in_class == classes_.end()) return nullptr;
  const auto of_element = in_class->second.find(kind_of(element));
  if (of_element == in_class->second.end()) return nullptr;
  const auto found = of_element->second.find(attribute);
  return found == of_element->second.end() ? nullptr : &found->second;
}

MjcfElement::MjcfElement(UrdfDocument& document, const MjcfDefaults& defaults, const tinyxml2::XMLElement& element,
                         const std::string& inherited)
    : document_(document), defaults_(defaults), element_(element), class_(inherited.empty() ? "main" : inherited) {
  for (const char* const attribute : {"class", "childclass"}) {
    const char* const given = element.Attribute(attribute);
    if (given == nullptr) continue;
    class_ = given;
    if (defaults.knows(class_)) continue;
    document.refuse(UrdfElement(document, element).at_value(attribute),
                    "class " + shown_quoted(class_) + " is in no <default>");
    class_ = "main";
  }
}

std::optional<MjcfValue> MjcfElement::find(const char* attribute) const {
  if (const char* const own = element_.Attribute(attribute); own != nullptr)
    return MjcfValue{own, UrdfElement(document_, element_).at_value(attribute)};
  const MjcfValue* const of_class = defaults_.find(class_, element_.Name(), attribute);
  return of_class == nullptr ? std::nullopt : std::optional(*of_class);
}

std::string MjcfElement::text(const char* attribute, const std::string& otherwise) const {
  const auto found = find(attribute);
  return found ? found->text : otherwise;
}

std::vector<double> MjcfElement::numbers(const char* attribute, std::size_t least, std::size_t most,
                                         const std::vector<double>& otherwise) const {
  const auto found = find(attribute);
  if (!found) return otherwise;
  const auto refuse = [&](const std::string& what) {
    document_.refuse(found->at, "'" + std::string(attribute) + "' of <" + shown(element_.Name()) + "> " + what);
    return otherwise;
  };
  std::vector<double> values;
  for (const std::string_view part : split(found->text, most + 1)) {
    if (const auto defect = read_value(UrdfValue::number, part, &values.emplace_back()))
      return refuse("has a part '" + shown(part) + "' that " + *defect);
  }
  if (values.size() < least || values.size() > most)
    return refuse(
        "has " + (values.size() > most ? "more than " + std::to_string(most) : std::to_string(values.size())) +
        " numbers, " + (least == most ? std::to_string(least) : std::to_string(least) + " to " + std::to_string(most)) +
        " were expected");
  return values;
}

double MjcfElement::number(const char* attribute, double otherwise) const {
  return numbers(attribute, 1, 1, {otherwise})[0];
}

std::optional<bool> MjcfElement::flag(const char* attribute, std::optional<bool> otherwise) const {
  const auto found = find(attribute);
  if (!found || found->text == "auto") return found ? std::nullopt : otherwise;
  if (found->text == "true" || found->text == "false") return found->text == "true";
  document_.refuse(found->at,
                   "'" + std::string(attribute) + "' is '" + shown(found->text) + "', and may be true, false or auto");
  return otherwise;
}

Pose MjcfElement::pose(const MjcfAngles& angles) const {
  return {vec3(numbers("pos", 3, 3, {0, 0, 0})), orientation(angles)};
}

Quat MjcfElement::orientation(const MjcfAngles& angles) const {
  const double angle = angles.degrees ? std::numbers::pi / 180 : 1;
  if (has("quat")) {
    const auto q = numbers("quat", 4, 4, {1, 0, 0, 0});
    if (std::hypot(std::hypot(q[0], q[1]), std::hypot(q[2], q[3])) > 0) return normalized({q[0], q[1], q[2], q[3]});
    document_.refuse(at(), "a 'quat' of zeros is no orientation");
  }
  if (has("axisangle")) {
    const auto a = numbers("axisangle", 4, 4, {0, 0, 1, 0});
    return from_axis_angle(unit({a[0], a[1], a[2]}), a[3] * angle);
  }
  if (has("euler")) {
    const auto turns = numbers("euler", 3, 3, {0, 0, 0});
    Quat q{1, 0, 0, 0};
    for (std::size_t i = 0; i < 3; ++i) {
      const char axis = angles.sequence[i];
      const bool fixed = axis >= 'X' && axis <= 'Z';
      Vec3 about{};
      about[static_cast<std::size_t>(fixed ? axis - 'X' : axis - 'x')] = 1;
      const Quat turn = from_axis_angle(about, turns[i] * angle);
      q = fixed ? multiply(turn, q) : multiply(q, turn);
    }
    return q;
  }
  if (has("xyaxes")) {
    const auto v = numbers("xyaxes", 6, 6, {1, 0, 0, 0, 1, 0});
    const Vec3 x = unit({v[0], v[1], v[2]});
    const double along = x[0] * v[3] + x[1] * v[4] + x[2] * v[5];
    const Vec3 y = unit({v[3] - along * x[0], v[4] - along * x[1], v[5] - along * x[2]});
    return of_columns(x, y, cross(x, y));
  }
  if (has("zaxis")) return z_to(vec3(numbers("zaxis", 3, 3, {0, 0, 1})));
  return {1, 0, 0, 0};
}

}  // namespace kadans
