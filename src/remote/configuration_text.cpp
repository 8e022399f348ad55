#include "kadans/remote/configuration_text.h"

#include <algorithm>

#include "kadans/campaign/durable_file.h"
#include "kadans/campaign/parameter_edit.h"
#include "kadans/config/json_value.h"

namespace kadans {
namespace {

ParameterEdit edit_of(const ParameterChange& change, const Catalog& catalog) {
  const auto id = catalog.parameters.find(change.name);
  const auto owner = std::ranges::find_if(catalog.objects, [&](const ObjectInfo& object) {
    return id && std::ranges::find(object.parameters, *id) != object.parameters.end();
  });
  if (owner == catalog.objects.end())
    throw InputError({.message = change.name + " belongs to no control object, so it has no place in the file; 'kadans "
                                               "ctl undo' takes the change back"});
  const std::string own = change.name.substr(owner->name.size() + 1);
  return {.object = owner->name, .pattern = own, .matched = {own}, .value = change.now};
}

}  // namespace

ConfigurationText::ConfigurationText(std::filesystem::path file) : file_(std::move(file)) {
  if (!file_.empty()) text_ = read_input_file(file_);
}

void ConfigurationText::save(const std::vector<ParameterChange>& changes, const Catalog& catalog) {
  const std::lock_guard lock(mutex_);
  const std::string name = file_.string();
  if (file_.empty()) throw InputError({.message = "this instance was not made from a configuration file"});
  if (read_input_file(file_) != text_)
    throw InputError({.file = name, .message = "was changed since this instance read it; nothing was saved"});
  std::vector<ParameterEdit> edits;
  for (const ParameterChange& change : changes) edits.push_back(edit_of(change, catalog));
  std::string text = edit_parameters(text_, name, edits);
  write_durably(std::filesystem::canonical(file_), text);  // not over a link to it
  text_ = std::move(text);
}

}  // namespace kadans
