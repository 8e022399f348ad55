
#include "urdf_document.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <iterator>
#include <set>
#include <span>
#include <tuple>
#include <utility>
#include <vector>

#include "kadans/signal/nearest_name.h"
#include "model/xml_scan.h"
#include "signal/number_text.h"

namespace kadans {
namespace {

constexpr double largest = 1e9;
constexpr std::size_t longest_name = 128, longest_number = 64;
constexpr std::size_t enough = 16;  // parts of a value: nothing in URDF has more than four
using Defect = std::optional<std::string>;
using tinyxml2::XMLElement;

// std::from_chars: no locale, no hexadecimal; a leading '+' is what it leaves out.
std::errc parse(std::string_view text, double& value) {
  if (text.starts_with('+') && !text.starts_with("+-")) text.remove_prefix(1);
  if (text.size() > longest_number) return std::errc::invalid_argument;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  return end != text.data() + text.size() ? std::errc::invalid_argument : error;
}

Defect read_number(std::string_view text, double& value) {
  const std::errc error = parse(text, value);
  if (text.empty()) return "is empty, a number was expected";
  if (error == std::errc::invalid_argument) {
    std::string pointed(text.substr(0, longest_number));
    std::replace(pointed.begin(), pointed.end(), ',', '.');
    const bool comma = pointed != text && parse(pointed, value) == std::errc();
    return comma ? "is not a number, did you mean '" + pointed + "'?" : "is not a number";
  }
  if (error == std::errc::result_out_of_range) return "is out of the range of numbers";
  if (!std::isfinite(value)) return "is not finite";
  if (!(std::abs(value) <= largest)) return "is beyond 1e9, too large for a robot";
  return std::nullopt;
}

// Writers mean "none" by a very large limit, and some write it as inf.
Defect read_limit(std::string_view text, double* value) {
  double read = 0;
  if (parse(text, read) != std::errc() || std::isnan(read)) {
    if (Defect defect = read_number(text, read)) return defect;
  }
  if (value != nullptr) *value = read;
  return std::nullopt;
}

Defect read_numbers(std::string_view text, std::span<double> values);

// ", did you mean '0 1 0'?" when commas or semicolons between the numbers were all that is wrong.
std::string spaces_meant(std::string_view text, std::size_t count) {
  if (text.size() > 4 * longest_number || text.find_first_of(",;") == std::string_view::npos) return {};
  std::string spaced(text);
  std::replace_if(
      spaced.begin(), spaced.end(), [](char c) { return c == ',' || c == ';'; }, ' ');
  const std::string better = listed(split(spaced, enough), {}, " ");
  std::vector<double> values(count);
  return read_numbers(better, values) ? "" : ", did you mean '" + better + "'?";
}

Defect read_numbers(std::string_view text, std::span<double> values) {
  const std::vector<std::string_view> parts = split(text, enough);
  const auto or_spaces = [&](const std::string& defect) {
    const std::string hint = spaces_meant(text, values.size());
    return hint.empty() ? defect : "is not separated by spaces" + hint;
  };
  if (parts.size() != values.size()) {
    return or_spaces("has " + std::to_string(parts.size()) + (parts.size() == 1 ? " number, " : " numbers, ") +
                     std::to_string(values.size()) + " were expected");
  }
  for (std::size_t i = 0; i < parts.size(); ++i) {
    if (const Defect defect = read_number(parts[i], values[i]))
      return or_spaces("has a part '" + shown(parts[i]) + "' that " + *defect);
  }
  return std::nullopt;
}

Defect name_defect(std::string_view text) {
  if (text.empty()) return "is empty";
  if (text.size() > longest_name) return "is longer than 128 characters";
  if (trimmed(text) != text) return "has blanks around it";
  if (find_non_text(text) || text.find_first_of("\t\r\n") != std::string_view::npos)
    return "has control characters in it";
  return std::nullopt;
}

struct NumberRule {
  std::size_t count;
  bool (*fits)(double);
  const char* otherwise;
};

constexpr bool is_any(double) { return true; }
constexpr bool is_not_negative(double v) { return v >= 0; }
constexpr bool is_fraction(double v) { return v >= 0 && v <= 1; }

constexpr NumberRule rules[] = {
    // in the order of UrdfValue, from `number`
    {1, is_any, ""},
    {1, is_not_negative, "must be >= 0"},
    {3, is_any, ""},
    {3, is_not_negative, "must be >= 0 in every direction"},
    {4, is_fraction, "must be red, green, blue and opacity in 0..1"},
};

}  // namespace

std::optional<std::string> read_value(UrdfValue kind, std::string_view text, double* numbers) {
  if (kind == UrdfValue::text) return std::nullopt;
  if (kind == UrdfValue::name) return name_defect(text);
  if (kind == UrdfValue::unbounded) return read_limit(trimmed(text), numbers);
  const NumberRule& rule = rules[static_cast<std::size_t>(kind) - static_cast<std::size_t>(UrdfValue::number)];
  std::array<double, 4> room{};
  const std::span<double> values(room.data(), rule.count);
  if (Defect defect = rule.count == 1 ? read_number(trimmed(text), values[0]) : read_numbers(text, values))
    return defect;
  if (!std::all_of(values.begin(), values.end(), rule.fits)) return rule.otherwise;
  if (numbers != nullptr) std::copy(values.begin(), values.end(), numbers);
  return std::nullopt;
}

namespace {

// " (40 such: also in lines 12, 19, 31 ...)" for further places.
std::string further(const std::vector<std::size_t>& places, const SourceText& source) {
  constexpr std::size_t most_lines = 3;
  if (places.size() < 2) return {};
  std::vector<int> lines;
  for (const std::size_t at : places) lines.push_back(source.place(at).line);
  std::ranges::sort(lines);
  const int first = lines.front();
  lines.erase(std::unique(lines.begin(), lines.end()), lines.end());
  lines.erase(std::ranges::find(lines, first));
  std::string text = " (" + std::to_string(places.size()) + " such";
  if (lines.empty()) return text + " in this line)";
  text += lines.size() == 1 ? ": also in line " : ": also in lines ";
  const auto first_lines = std::span(lines).first(std::min(lines.size(), most_lines));
  text += listed(first_lines, [](int line) { return std::to_string(line); });
  return text + (lines.size() > most_lines ? " ...)" : ")");
}

void sort_by_place(std::vector<InputProblem>& problems) {
  std::ranges::stable_sort(problems, [](const InputProblem& a, const InputProblem& b) {
    return std::tie(a.line, a.column) < std::tie(b.line, b.column);
  });
}

}  // namespace

void UrdfNotes::add(std::size_t at, std::string message, std::string_view kind) {
  auto found = kinds_.find(kind.empty() ? std::string_view(message) : kind);
  if (found == kinds_.end() && full()) {
    ++left_out_;
    return;
  }
  if (found == kinds_.end()) found = kinds_.emplace(kind.empty() ? message : std::string(kind), Kind{}).first;
  Kind& to = found->second;
  if (to.places.empty() || at < to.first) to.message = std::move(message), to.first = at;
  to.places.push_back(at);
}

std::vector<InputProblem> UrdfNotes::told(const std::string& file, const SourceText& source) const {
  std::vector<InputProblem> problems;
  for (const auto& [kind, of] : kinds_) {
    const TextPlace place = source.place(of.first);
    problems.push_back({file, place.line, place.column, of.message + further(of.places, source)});
  }
  sort_by_place(problems);
  if (left_out_ > 0) problems.push_back({file, 0, 0, "and " + std::to_string(left_out_) + " more of other kinds"});
  return problems;
}

UrdfDocument::UrdfDocument(std::string_view whole, std::string file)
    : file_(std::move(file)), source_(whole.substr(0, whole.find_last_not_of('\0') + 1)) {
  const std::string_view text = source_.text();
  const auto fail = [&](const TextProblem& found) { throw InputError(problem(found.at, found.message)); };
  if (const auto found = find_non_text(text)) fail(*found);
  scan_ = scan_xml(source_);
  if (scan_.problem) fail(*scan_.problem);
  if (xml_.Parse(text.data(), text.size()) != tinyxml2::XML_SUCCESS || xml_.RootElement() == nullptr) {
    throw InputError(
        InputProblem{file_, xml_.ErrorLineNum(), 0, std::string("not well-formed XML: ") + xml_.ErrorName()});
  }
  link_tags();
  if (text.size() < whole.size()) warn(text.size(), "NUL bytes at the end of the file are not used");
}

// Gives every element of the DOM, in the order of the document, the scan's tag.
void UrdfDocument::link_tags() {
  XMLElement* element = xml_.RootElement();
  for (XmlTag& tag : scan_.tags) {
    if (element == nullptr || tag.name != element->Name()) throw InputError(problem(tag.at, "not well-formed XML"));
    element->SetUserData(&tag);
    XMLElement* next = element->FirstChildElement();
    for (tinyxml2::XMLNode* up = element; next == nullptr && up != nullptr && up != xml_.RootElement();
         up = up->Parent()) {
      next = up->NextSiblingElement();
    }
    element = next;
  }
  if (element != nullptr) throw InputError({file_, element->GetLineNum(), 0, "not well-formed XML"});
}

const XmlTag& UrdfDocument::tag(const XMLElement& element) {
  return *static_cast<const XmlTag*>(element.GetUserData());
}

InputProblem UrdfDocument::problem(std::size_t at, std::string message) const {
  const TextPlace place = source_.place(at);
  return {file_, place.line, place.column, std::move(message)};
}

void UrdfDocument::refuse(std::size_t at, std::string message, std::string_view kind) {
  if (!consequence_.empty()) {
    ++softened_;
    return warn(at, message.append("; ").append(consequence_), kind);
  }
  refused_.add(at, std::move(message), kind);
  if (refused_.full()) throw_refused();
}

void UrdfDocument::stop(std::size_t at, std::string message) {
  refused_.add(at, std::move(message), {});
  throw_refused();
}

void UrdfDocument::warn(std::size_t at, std::string message, std::string_view kind) {
  warnings_.add(at, std::move(message), kind);
}

UrdfDocument::Lenient::Lenient(UrdfDocument& document, std::string consequence)
    : document_(document),
      consequence_before_(std::exchange(document.consequence_, std::move(consequence))),
      softened_before_(std::exchange(document.softened_, 0)) {}

UrdfDocument::Lenient::~Lenient() {
  document_.consequence_ = std::move(consequence_before_);
  document_.softened_ = softened_before_;
}

void UrdfDocument::throw_if_refused(bool strict) {
  if (!refused_.empty() || (strict && !warnings_.empty())) throw_refused(strict);
}

void UrdfDocument::throw_refused(bool strict) {
  std::vector<InputProblem> problems = refused_.told(file_, source_);
  if (strict) {
    std::ranges::move(warnings(), std::back_inserter(problems));
    sort_by_place(problems);
  }
  if (refused_.full()) problems.push_back({file_, 0, 0, "there may be more: reading stopped here"});
  throw InputError(problems);
}

namespace {

template <typename Known>
const Known* find_known(const std::vector<Known>& all, std::string_view name) {
  const auto found = std::find_if(all.begin(), all.end(), [&](const Known& known) { return known.name == name; });
  return found == all.end() ? nullptr : &*found;
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
    if (wanted == nullptr) {
      unknown_attribute(a->Name(), names_of(known), meant);
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

void UrdfElement::unknown_attribute(const char* name, const std::vector<std::string>& known,
                                    std::set<std::string, std::less<>>& meant) const {
  const std::string nearest = of_others(name) ? "" : nearest_name(name, known);
  const std::string what = "attribute '" + shown(name) + "' of " + shown_name();
  if (nearest.empty() || has(nearest.c_str()))
    return document_.warn(at_name(name), what + " is not known to URDF, and not used",
                          std::string_view(name).starts_with("xmlns") ? "name space" : "");
  meant.insert(nearest);
  document_.refuse(at_name(name), "unknown " + what + ", did you mean '" + nearest + "'?");
}

void UrdfElement::children(const std::vector<UrdfChild>& known) const {
  if (const std::size_t text_at = UrdfDocument::tag(element_).text_at; text_at != std::string_view::npos)
    document_.warn(text_at, "text in " + shown_name() + ", which has none, is not used");
  std::set<std::string, std::less<>> seen, meant;
  for (const auto* e = element_.FirstChildElement(); e != nullptr; e = e->NextSiblingElement()) {
    const UrdfElement child(document_, *e);
    const UrdfChild* wanted = find_known(known, e->Name());
    if (wanted == nullptr) {
      unknown_child(child, known, meant);
    } else if (seen.insert(e->Name()).second || wanted->count == UrdfCount::any) {
      wanted->read(child);
    } else {
      document_.warn(child.at(), "a second " + child.shown_name() + " in " + shown_name() + ": the first counts");
    }
  }
  for (const UrdfChild& wanted : known) {
    if (wanted.count == UrdfCount::one && !seen.contains(wanted.name) && !meant.contains(wanted.name))
      document_.refuse(at(), shown_name() + " has no <" + wanted.name + ">");
  }
}

void UrdfElement::unknown_child(const UrdfElement& child, const std::vector<UrdfChild>& known,
                                std::set<std::string, std::less<>>& meant) const {
  const char* const name = child.element_.Name();
  const std::string nearest = of_others(name) ? "" : nearest_name(name, names_of(known));
  const UrdfChild* wanted = find_known(known, nearest);
  const std::string what = child.shown_name() + " in " + shown_name();
  if (wanted == nullptr || (wanted->count != UrdfCount::any && element_.FirstChildElement(nearest.c_str()) != nullptr))
    return document_.warn(child.at(), what + " is not known to URDF, and not used");
  meant.insert(nearest);
  document_.refuse(child.at(), "unknown element " + what + ", did you mean '" + nearest + "'?");
}

bool UrdfElement::leaf(const std::vector<UrdfAttribute>& known) const {
  const bool right = attributes(known);
  children({});
  return right;
}

}  // namespace kadans
