// The bench as a plug-in, which any kadans loads whose robot lists it.
#include "bench.h"
#include "kadans/control/plugin.h"

KADANS_PLUGIN(kadans::plugin_type<make_bench_type>())
