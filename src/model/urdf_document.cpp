#include "urdf_document.h"

#include <algorithm>
#include <tuple>

#include "urdf_grammar.h"

namespace kadans {
namespace {

using tinyxml2::XMLElement;

constexpr std::size_t max_problems = 25;  // more than anybody reads at once; bounds the work on hostile files

void copy_known(const XMLElement& from, XMLElement& to) {
  for (const auto* attribute = from.FirstAttribute(); attribute != nullptr; attribute = attribute->Next()) {
    if (!known_attribute(from.Name(), attribute->Name())) continue;
    std::string value = attribute->Value();
    std::replace_if(
        value.begin(), value.end(), [](char c) { return c == '\t' || c == '\n' || c == '\r'; }, ' ');
    const std::size_t first = std::min(value.find_first_not_of(' '), value.size());
    to.SetAttribute(attribute->Name(), value.substr(first, value.find_last_not_of(' ') + 1 - first).c_str());
  }
  for (const auto* child = from.FirstChildElement(); child != nullptr; child = child->NextSiblingElement()) {
    if (known_child(from.Name(), child->Name())) copy_known(*child, *to.InsertNewChildElement(child->Name()));
  }
}

}  // namespace

UrdfDocument::UrdfDocument(std::string_view text, std::string file) : file_(std::move(file)), source_(text) {
  const auto fail = [&](const TextProblem& problem) {
    const TextPlace place = source_.place(problem.at);
    throw InputError(InputProblem{file_, place.line, place.column, problem.message});
  };
  if (const auto problem = find_non_text(text)) fail(*problem);
  scan_ = scan_xml(source_);
  if (scan_.problem) fail(*scan_.problem);
  if (xml_.Parse(text.data(), text.size()) != tinyxml2::XML_SUCCESS || xml_.RootElement() == nullptr) {
    throw InputError(
        InputProblem{file_, xml_.ErrorLineNum(), 0, std::string("not well-formed XML: ") + xml_.ErrorName()});
  }
  link_tags();
}

// Gives every element of the DOM, in the order of the document, the scan's tag.
void UrdfDocument::link_tags() {
  XMLElement* element = xml_.RootElement();
  for (XmlTag& tag : scan_.tags) {
    if (element == nullptr || tag.name != element->Name()) {
      throw InputError(
          InputProblem{file_, source_.place(tag.at).line, source_.place(tag.at).column, "not well-formed XML"});
    }
    element->SetUserData(&tag);
    XMLElement* next = element->FirstChildElement();
    for (tinyxml2::XMLNode* up = element; next == nullptr && up != nullptr && up != xml_.RootElement();
         up = up->Parent()) {
      next = up->NextSiblingElement();
    }
    element = next;
  }
}

const XmlTag& UrdfDocument::tag(const XMLElement& element) const {
  return *static_cast<const XmlTag*>(element.GetUserData());
}

const XmlAttribute* UrdfDocument::attribute(const XMLElement& element, std::string_view name) const {
  const std::vector<XmlAttribute>& all = tag(element).attributes;
  const auto found = std::find_if(all.begin(), all.end(), [&](const XmlAttribute& a) { return a.name == name; });
  return found == all.end() ? nullptr : &*found;
}

int UrdfDocument::line(const XMLElement& element) const { return source_.place(tag(element).at).line; }

void UrdfDocument::refuse(const XMLElement& element, std::string message) {
  refuse_at(tag(element).at, std::move(message));
}

void UrdfDocument::refuse_name(const XMLElement& element, std::string_view name, std::string message) {
  const XmlAttribute* found = attribute(element, name);
  refuse_at(found == nullptr ? tag(element).at : found->name_at, std::move(message));
}

void UrdfDocument::refuse_value(const XMLElement& element, std::string_view name, std::string message) {
  const XmlAttribute* found = attribute(element, name);
  refuse_at(found == nullptr ? tag(element).at : found->value_at, std::move(message));
}

bool UrdfDocument::has_text(const XMLElement& element) const { return tag(element).text_at != std::string_view::npos; }

void UrdfDocument::refuse_text(const XMLElement& element, std::string message) {
  refuse_at(tag(element).text_at, std::move(message));
}

void UrdfDocument::refuse_at(std::size_t at, std::string message) {
  const TextPlace place = source_.place(at);
  problems_.push_back({file_, place.line, place.column, std::move(message)});
  if (problems_.size() >= max_problems) throw_if_refused();
}

void UrdfDocument::throw_if_refused() {
  if (!refused()) return;
  std::stable_sort(problems_.begin(), problems_.end(), [](const InputProblem& a, const InputProblem& b) {
    return std::tie(a.line, a.column) < std::tie(b.line, b.column);
  });
  if (problems_.size() >= max_problems) problems_.push_back({file_, 0, 0, "there may be more: reading stopped here"});
  throw InputError(problems_);
}

std::string UrdfDocument::reprinted() const {
  tinyxml2::XMLDocument clean;
  clean.InsertEndChild(clean.NewElement("robot"));
  copy_known(robot(), *clean.RootElement());
  tinyxml2::XMLPrinter printer;
  clean.Print(&printer);
  return printer.CStr();
}

std::string attribute_or_empty(const XMLElement& element, const char* name) {
  const char* value = element.Attribute(name);
  return value == nullptr ? "" : value;
}

}  // namespace kadans
