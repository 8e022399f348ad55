// Plug-ins: types of control objects and of plants in a shared library that a robot's configuration lists under
// "plugins". In one source file of a library that CMake's kadans_plugin() builds:
//
//   KADANS_PLUGIN(kadans::plugin_type<make_spring>("spring"), kadans::plugin_type<make_bench_type>())
//
// where make_spring is a std::unique_ptr<kadans::ControlObject> (const kadans::ObjectSetup&), and make_bench_type a
// std::unique_ptr<kadans::PlantType> ().
//
// The program gets the object itself and calls it as one of its own. So a plug-in can do whatever an object can that is
// built in, and what its functions throw arrives as it was thrown. In return both must be built alike: the library
// exports one symbol, kadans_plugin, a descriptor that says how it was built. The program compares that with its own
// build before it believes anything else, and refuses a library that differs (plugin_library.h).
//
// Where the plug-in's functions come from: a plug-in links the package's static libraries and hides what it takes from
// them. The program shows no functions but its mathematics (src/signal/portable_math.cpp), so nothing of Kadans is
// bound across: the two sides meet in virtual functions, in data and in the C++ library, which both share. Therefore a
// plug-in also fits a program of your own that links Kadans. What a process has once does not work from a plug-in:
// - KADANS_REGISTER_CONTROL_OBJECT and KADANS_REGISTER_PLANT_TYPE fill a list that only the plug-in has: name the types
//   in KADANS_PLUGIN.
// - Bullet's memory, the types of plants, scripts and the program itself: kadans_plugin() refuses to link them.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>

#include "kadans/control/control_object.h"
#include "kadans/control/sdk_version.h"
#include "kadans/plant/plant_type.h"
#include "kadans/signal/machine_name.h"

// How this was built, as far as it decides what objects look like in memory: parts in words, separated by ", ". Flags
// such as NDEBUG and _GLIBCXX_ASSERTIONS change no object, so they may differ.
#define KADANS_WORDS(text) KADANS_WORDS_OF(text)
#define KADANS_WORDS_OF(text) #text
#if defined(__clang__)
#define KADANS_BUILD_COMPILER "clang " KADANS_WORDS(__clang_major__)
#else
#define KADANS_BUILD_COMPILER "gcc " KADANS_WORDS(__GNUC__)
#endif
#if defined(_LIBCPP_VERSION)
#define KADANS_BUILD_LIBRARY "libc++ " KADANS_WORDS(_LIBCPP_VERSION) ", string ABI " KADANS_WORDS(_LIBCPP_ABI_VERSION)
#else
#define KADANS_BUILD_LIBRARY \
  "libstdc++ " KADANS_WORDS(_GLIBCXX_RELEASE) ", string ABI " KADANS_WORDS(_GLIBCXX_USE_CXX11_ABI)
#endif
#if defined(_GLIBCXX_DEBUG)
#define KADANS_BUILD_CONTAINERS "containers that check"
#else
#define KADANS_BUILD_CONTAINERS "containers that do not check"
#endif
// As Eigen decides it, included before or not: by hand, else by the vectors that the compiler may use.
#if defined(EIGEN_MAX_ALIGN_BYTES)
#define KADANS_BUILD_ALIGNMENT KADANS_WORDS(EIGEN_MAX_ALIGN_BYTES)
#elif defined(EIGEN_DONT_ALIGN)
#define KADANS_BUILD_ALIGNMENT "0"
#elif defined(__AVX512F__)
#define KADANS_BUILD_ALIGNMENT "64"
#elif defined(__AVX__)
#define KADANS_BUILD_ALIGNMENT "32"
#else
#define KADANS_BUILD_ALIGNMENT "16"
#endif
#define KADANS_BUILD                                                                                               \
  KADANS_SDK ", " KADANS_BUILD_COMPILER ", " KADANS_BUILD_LIBRARY ", " KADANS_BUILD_CONTAINERS ", " KADANS_MACHINE \
             ", pointers of " KADANS_WORDS(__SIZEOF_POINTER__) " bytes, Eigen aligned to " KADANS_BUILD_ALIGNMENT

namespace kadans {

// One type: `make_object` and its name, or `make_plant`, whose name the type itself says.
struct PluginType {
  const char* name = nullptr;
  std::unique_ptr<ControlObject> (*make_object)(const ObjectSetup&) = nullptr;
  MakePlantType make_plant = nullptr;
};

struct PluginDescriptor {
  // These three stand where they do for ever. `size` is the descriptor's, `build` ends with a 0.
  char magic[16] = "kadans plug-in";
  std::uint32_t size = sizeof(PluginDescriptor);
  char build[236] = KADANS_BUILD;
  // The rest is believed when the build is the program's.
  std::uint32_t count = 0;
  const PluginType* types = nullptr;
};
static_assert(offsetof(PluginDescriptor, size) == 16 && offsetof(PluginDescriptor, build) == 20 &&
              offsetof(PluginDescriptor, count) == 256);

template <std::unique_ptr<ControlObject> (*make)(const ObjectSetup&)>
constexpr PluginType plugin_type(const char* name) noexcept {
  return {.name = name, .make_object = make};
}
template <MakePlantType make>
constexpr PluginType plugin_type() noexcept {
  return {.make_plant = make};
}

template <std::size_t count>
constexpr PluginDescriptor plugin_of(const PluginType (&types)[count]) noexcept {
  return {.count = count, .types = types};
}

}  // namespace kadans

extern "C" __attribute__((visibility("default"))) const kadans::PluginDescriptor kadans_plugin;

// The descriptor is a constant: none of the plug-in's code runs to make it.
#define KADANS_PLUGIN(...)                                              \
  namespace {                                                           \
  constexpr ::kadans::PluginType kadans_plugin_types[] = {__VA_ARGS__}; \
  }                                                                     \
  constinit const ::kadans::PluginDescriptor kadans_plugin = ::kadans::plugin_of(kadans_plugin_types);
