// A good plug-in, made as everybody would.
#include "kadans/control/plugin_glue.h"
#include "spring.h"

KADANS_PLUGIN(kadans::plugin_type<make_spring>("spring"))
