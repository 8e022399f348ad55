#include "urdf_document.h"

#include <algorithm>
#include <tuple>

namespace kadans {
namespace {

using tinyxml2::XMLElement;

constexpr std::size_t most_told = 25;  // more than anybody reads at once; bounds the work on hostile files

void sort_by_place(std::vector<InputProblem>& problems) {
  std::stable_sort(problems.begin(), problems.end(), [](const InputProblem& a, const InputProblem& b) {
    return std::tie(a.line, a.column) < std::tie(b.line, b.column);
  });
}

}  // namespace

UrdfDocument::UrdfDocument(std::string_view text, std::string file) : file_(std::move(file)), source_(text) {
  const auto fail = [&](const TextProblem& found) { throw InputError(problem(found.at, found.message)); };
  if (const auto found = find_non_text(text)) fail(*found);
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

void UrdfDocument::refuse(std::size_t at, std::string message) {
  refused_.push_back(problem(at, std::move(message)));
  if (refused_.size() >= most_told) throw_refused();
}

void UrdfDocument::stop(std::size_t at, std::string message) {
  refused_.push_back(problem(at, std::move(message)));
  throw_refused();
}

void UrdfDocument::warn(std::size_t at, std::string message) {
  if (warnings_.size() < most_told)
    warnings_.push_back(problem(at, std::move(message)));
  else
    ++warnings_left_out_;
}

void UrdfDocument::throw_if_refused() {
  if (!refused_.empty()) throw_refused();
}

void UrdfDocument::throw_refused() {
  sort_by_place(refused_);
  if (refused_.size() >= most_told) refused_.push_back({file_, 0, 0, "there may be more: reading stopped here"});
  throw InputError(refused_);
}

std::vector<InputProblem> UrdfDocument::warnings() const {
  std::vector<InputProblem> told = warnings_;
  sort_by_place(told);
  if (warnings_left_out_ > 0) told.push_back({file_, 0, 0, "and " + std::to_string(warnings_left_out_) + " more"});
  return told;
}

}  // namespace kadans
