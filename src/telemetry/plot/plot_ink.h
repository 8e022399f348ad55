// The colors of a plot on light and on dark paper.
#pragma once

#include <array>
#include <cstddef>

namespace kadans {

struct PlotColor {
  const char *light, *dark;
};

namespace plot_ink {
inline constexpr PlotColor paper{"#fefefe", "#12181e"}, text{"#1c2833", "#dde5ec"}, frame{"#8a97a3", "#5a6874"},
    grid{"#d9e0e6", "#232d36"}, shade{"#f1f4f7", "#19212a"}, fault{"#c62828", "#ff8a80"}, push{"#6a3d9a", "#c5a3ea"};
// Colors that color-blind readers can tell apart, too (Okabe and Ito), on light and dark paper.
inline constexpr std::array<PlotColor, 8> lines{{{"#0072b2", "#4ba9e0"},
                                                 {"#d55e00", "#f28a3c"},
                                                 {"#009e73", "#3cc79b"},
                                                 {"#cc79a7", "#dd95bd"},
                                                 {"#e69f00", "#f0b73a"},
                                                 {"#56b4e9", "#86cbf2"},
                                                 {"#8c6d31", "#c09a55"},
                                                 {"#7f7f7f", "#a5a5a5"}}};
inline constexpr std::array<PlotColor, 6> states{{{"#cfe3f2", "#1f4460"},
                                                  {"#f7dfc4", "#5b3c1c"},
                                                  {"#cfeadd", "#1d4d3a"},
                                                  {"#efd8e6", "#53304a"},
                                                  {"#f4ecc2", "#4d4419"},
                                                  {"#dcdff2", "#353a66"}}};
}  // namespace plot_ink

}  // namespace kadans
