#include "urdf_element.h"

#include <algorithm>
#include <set>

#include "signal/nearest_name.h"

namespace kadans {
namespace {

template <typename Known>
const Known* find_known(const std::vector<Known>& all, std::string_view name) {
  const auto found = std::find_if(all.begin(), all.end(), [&](const Known& known) { return known.name == name; });
  return found == all.end() ? nullptr : &*found;
}

// ", did you mean 'mass'?" or, with nothing near, what there is to choose from.
std::string choice(const std::string& nearest, const std::vector<std::string>& known) {
  if (!nearest.empty()) return ", did you mean '" + nearest + "'?";
  std::string list;
  for (const std::string& name : known) list += (list.empty() ? "; known are: " : ", ") + name;
  return list.empty() ? "; it has none" : list;
}

bool of_others(std::string_view name) { return name == "xmlns" || name.find(':') != std::string_view::npos; }

}  // namespace

std::size_t UrdfElement::at_name(std::string_view attribute) const {
  const XmlAttribute* found = find_known(UrdfDocument::tag(element_).attributes, attribute);
  return found == nullptr ? at() : found->name_at;
}

std::size_t UrdfElement::at_value(std::string_view attribute) const {
  const XmlAttribute* found = find_known(UrdfDocument::tag(element_).attributes, attribute);
  return found == nullptr ? at() : found->value_at;
}

std::string UrdfElement::text(const char* attribute, const char* otherwise) const {
  return shown(has(attribute) ? element_.Attribute(attribute) : otherwise);
}

bool UrdfElement::attributes(const std::vector<UrdfAttribute>& known) const {
  bool right = true;
  std::set<std::string, std::less<>> meant;  // by misspelt ones: these are not told to be missing, too
  for (const auto* a = element_.FirstAttribute(); a != nullptr; a = a->Next()) {
    const UrdfAttribute* wanted = find_known(known, a->Name());
    if (wanted == nullptr && of_others(a->Name())) continue;
    if (wanted == nullptr) {
      const std::vector<std::string> names = names_of(known);
      const std::string nearest = nearest_name(a->Name(), names);
      meant.insert(nearest);
      document_.refuse(at_name(a->Name()),
                       "unknown attribute '" + shown(a->Name()) + "' of " + shown_name() + choice(nearest, names));
      continue;
    }
    if (auto* const* const to = std::get_if<std::string*>(&wanted->to)) **to = a->Value();
    double* const* const numbers = std::get_if<double*>(&wanted->to);
    if (const auto defect = read_value(wanted->kind, a->Value(), numbers == nullptr ? nullptr : *numbers)) {
      right = false;
      document_.refuse(at_value(a->Name()),
                       shown_name() + " " + wanted->name + " '" + shown(a->Value()) + "' " + *defect);
    }
  }
  for (const UrdfAttribute& wanted : known) {
    if (!wanted.required || has(wanted.name)) continue;
    right = false;
    if (!meant.contains(wanted.name)) document_.refuse(at(), shown_name() + " has no attribute '" + wanted.name + "'");
  }
  return right;
}

std::size_t UrdfElement::children(const std::vector<UrdfChild>& known) const {
  const std::string_view own = element_.Name();
  if (const std::size_t text_at = UrdfDocument::tag(element_).text_at; text_at != std::string_view::npos)
    document_.refuse(text_at, "text in " + shown_name() + ", which has none");
  const std::vector<std::string> names = names_of(known);
  std::size_t all = 0, count = 0;
  std::set<std::string, std::less<>> seen, meant;
  for (const auto* e = element_.FirstChildElement(); e != nullptr; e = e->NextSiblingElement()) {
    const UrdfElement child(document_, *e);
    const UrdfChild* wanted = find_known(known, e->Name());
    const std::string nearest = wanted == nullptr ? nearest_name(e->Name(), names) : e->Name();
    const bool others = wanted == nullptr && (of_others(e->Name()) || (own == "robot" && nearest.empty()));
    if (!others) ++count;
    if (wanted == nullptr && !others) {
      meant.insert(nearest);
      const std::string what = own == "geometry" ? "unknown geometry " + child.shown_name()
                                                 : "unknown element " + child.shown_name() + " in " + shown_name();
      document_.refuse(child.at(), what + choice(nearest, names));
    } else if (wanted != nullptr && (seen.insert(nearest).second || wanted->count == UrdfCount::any)) {
      wanted->read(child);
    } else if (wanted != nullptr) {
      document_.refuse(child.at(), "a second " + child.shown_name() + " in " + shown_name());
    }
    if (++all == 2 && own == "geometry") document_.refuse(child.at(), "a second shape in one <geometry>");
  }
  for (const UrdfChild& wanted : known) {
    if (wanted.count == UrdfCount::one && !seen.contains(wanted.name) && !meant.contains(wanted.name))
      document_.refuse(at(), shown_name() + " has no <" + wanted.name + ">");
  }
  return count;
}

bool UrdfElement::leaf(const std::vector<UrdfAttribute>& known) const {
  const bool right = attributes(known);
  children({});
  return right;
}

}  // namespace kadans
