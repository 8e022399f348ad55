#include "kadans/config/input_object.h"

#include "config/robot/project_root.h"
#include "config/scenario/based_on.h"
#include "fields.h"
#include "signal/input_file.h"

namespace kadans {
namespace {

Need need(bool required) { return required ? Need::required : Need::optional; }

}  // namespace

bool InputObject::number(std::string_view name, double& value, Range range, std::string_view doc, bool required) {
  return fields_->number(name, value, {range.min, range.max, range.unit}, doc, need(required));
}

bool InputObject::whole(std::string_view name, std::uint64_t& value, std::uint64_t min, std::uint64_t max,
                        std::string_view doc, bool required) {
  return fields_->integer(name, value, {min, max, {}}, doc, need(required));
}

bool InputObject::text(std::string_view name, std::string& value, std::string_view doc, bool required) {
  return fields_->string(name, value, doc, need(required));
}

bool InputObject::choice(std::string_view name, std::size_t& value, std::span<const std::string> names,
                         std::string_view doc, bool required) {
  return fields_->choice(name, value, names, doc, need(required));
}

bool InputObject::object(std::string_view name, std::string_view doc, const Read& read, bool required) {
  return fields_->object(
      name, doc,
      [&](Fields& inner) {
        InputObject object(inner);
        read(object);
      },
      need(required));
}

bool InputObject::list(std::string_view name, std::string_view doc, const Read& read, bool required) {
  return fields_->list(
      name, {}, doc,
      [&](Fields& inner) {
        InputObject object(inner);
        read(object);
      },
      need(required));
}

bool InputObject::reading() const noexcept { return fields_->reading(); }

bool InputObject::path(std::string_view name, std::string& value, std::string_view doc, bool required) {
  return fields_->string(name, value, doc, need(required)) &&
         !resolve_file_or_folder(value, fields_->place(name), fields_->path(name), fields_->problems()).empty();
}

bool InputObject::is_file(const std::string& path) const {
  std::error_code ignored;
  return std::filesystem::is_regular_file(resolve(path, fields_->problems().file()), ignored);
}

void InputObject::refuse(std::string_view name, const std::string& message) {
  fields_->refuse(fields_->place(name), message);
}

InputProblem InputObject::place(std::string_view name) const {
  const TextPlace at = fields_->place(name);
  return {.file = fields_->problems().file(), .line = at.line, .column = at.column, .message = {}};
}

void read_input_object(const std::filesystem::path& file, const InputObject::Read& read) {
  read_input_text(read_input_file(file), file, read);
}

void read_input_text(std::string_view text, const std::filesystem::path& file, const InputObject::Read& read) {
  const auto read_base = [&](const std::filesystem::path& base) { read_input_object(base, read); };
  read_based_fields(text, file.string(), read_base, [&](Fields& fields) {
    InputObject object(fields);
    read(object);
  });
}

}  // namespace kadans
