#include "kadans/model/urdf.h"

#include <cstdint>
#include <filesystem>

#include "kadans/signal/input_error.h"
#include "kadans/signal/input_file.h"
#include "urdf_checks.h"
#include "urdf_dom.h"
#include "urdf_grammar.h"
#include "urdf_merge.h"

namespace kadans {
namespace {

constexpr std::uintmax_t max_size = 16U << 20U;

[[noreturn]] void fail(const std::string& file, const std::string& message) {
  throw InputError(InputProblem{file, 0, 0, message});
}

void check_size(const std::string& file, std::uintmax_t size) {
  if (size == 0) fail(file, "the file is empty");
  if (size > max_size) fail(file, "the file has " + std::to_string(size) + " bytes, a URDF may have 16 MiB");
}

// Our own pass finds what is wrong and where; urdfdom then reads what is known to be right, and may still object.
urdf::ModelInterfaceSharedPtr checked_dom(UrdfDocument& document) {
  const UrdfDom dom = parse_with_urdfdom(document.reprinted());
  for (const std::string& complaint : dom.complaints) document.refuse(document.robot(), "urdfdom: " + complaint);
  document.throw_if_refused();
  return dom.model;
}

}  // namespace

RobotModel read_urdf(const std::string& file, const UrdfOptions& options) {
  return read_urdf_text(read_input_file(file, max_size), file, options);
}

RobotModel read_urdf_text(const std::string& text, const std::string& file, const UrdfOptions& options) {
  check_size(file, text.size());
  UrdfDocument document(text, file);
  check_xacro(document);
  check_grammar(document);
  const UrdfOutline outline = outline_of(document);
  check_links(document, outline, options);
  check_joints(document, outline);
  check_mimics(document, outline);
  check_tree(document, outline);
  document.throw_if_refused();
  return merge_fixed_joints(*checked_dom(document), outline.joint_names(), file);
}

}  // namespace kadans
