// A plug-in that uses nothing of Kadans but headers, so that it loads however it was built.
#include "kadans/control/plugin.h"

namespace {
std::unique_ptr<kadans::ControlObject> make_nothing(const kadans::ObjectSetup&) { return nullptr; }
}  // namespace

KADANS_PLUGIN(kadans::plugin_type<make_nothing>("nothing"))
