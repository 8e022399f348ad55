#include "option_link.h"

#include "kadans/signal/nearest_name.h"

namespace kadans {

std::size_t link_named(const ObjectSetup& setup, const std::string& option, const std::string& name) {
  const auto link = setup.model.find_link(name);
  if (!link)
    throw OptionError(option, "there is no link '" + name + "'" + did_you_mean(name, setup.model.link_names()));
  return *link;
}

std::size_t required_link(const ObjectSetup& setup, const std::string& option, const std::string& meaning) {
  const std::string* const name = setup.options.find(option);
  if (name == nullptr) throw OptionError(option, "it needs the option '" + option + "': " + meaning);
  return link_named(setup, option, *name);
}

}  // namespace kadans
