// The kind of processor that this program was made for.
#pragma once

#if defined(__x86_64__)
#define KADANS_MACHINE "x86_64"
#elif defined(__i386__)
#define KADANS_MACHINE "i386"
#elif defined(__aarch64__)
#define KADANS_MACHINE "aarch64"
#else
#define KADANS_MACHINE "other"
#endif

namespace kadans {

// The same run gives the same hash on processors of one name; on others the last bits
// of sines and cosines may differ.
constexpr const char* machine_name() noexcept { return KADANS_MACHINE; }

}  // namespace kadans
