// mcap_cut RECORD OUT: what mcap_check/cut.mjs reads: two seconds of a record, the signals of one joint and the base.
#include <cstdio>

#include "kadans/signal/input_error.h"
#include "telemetry/reading/record_export.h"

int main(int argc, char** argv) {
  if (argc != 3) {
    std::fputs("usage: mcap_cut RECORD OUT\n", stderr);
    return 2;
  }
  try {
    const kadans::RecordCut cut{.span = {1'500'000'000, 3'500'000'000}, .signals = {"joint.l_knee", "base"}};
    (void)kadans::cut_record(kadans::outline_of(argv[1]), cut, argv[2]);
  } catch (const kadans::InputError& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 1;
  }
  return 0;
}
