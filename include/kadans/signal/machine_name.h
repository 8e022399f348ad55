// The kind of processor that this program was made for.
#pragma once

namespace kadans {

// The same run gives the same hash on processors of one name; on others the last bits of sines and cosines may differ.
constexpr const char* machine_name() noexcept {
#if defined(__x86_64__)
  return "x86_64";
#elif defined(__i386__)
  return "i386";
#elif defined(__aarch64__)
  return "aarch64";
#else
  return "other";
#endif
}

}  // namespace kadans
