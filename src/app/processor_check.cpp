// Kadans for i386 needs SSE2. Without it the program would die of an illegal instruction, perhaps before main(): in a
// constructor of its own or of a library. So the loader calls this check first, and it is compiled without SSE.
//
// It is a source of each program, not of a library, from which the linker would leave it out. On other architectures it
// is empty: there every processor has what the program needs.
#if defined(__i386__)

#include <unistd.h>

#define KADANS_WITHOUT_SSE __attribute__((target("no-sse,fpmath=387")))

namespace {

KADANS_WITHOUT_SSE void refuse_processor_without_sse2(int, char**, char**) {
  __builtin_cpu_init();
  if (__builtin_cpu_supports("sse2") != 0) return;
  static constexpr char sentence[] =
      "kadans: this processor has no SSE2, which Kadans needs on i386 (a Pentium 4, a Pentium M, a VIA C7, or a newer "
      "one has it)\n";
  (void)!write(STDERR_FILENO, sentence, sizeof sentence - 1);
  _exit(2);
}

using Check = void (*)(int, char**, char**);
__attribute__((section(".preinit_array"), used)) const Check first_of_all = refuse_processor_without_sse2;

}  // namespace

#endif
