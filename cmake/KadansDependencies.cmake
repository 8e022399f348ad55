# Every dependency is a Debian package that scripts/setup installs; third_party_notes.md says why each is there.
find_package(PkgConfig REQUIRED)
find_package(Threads REQUIRED)
find_package(Eigen3 REQUIRED NO_MODULE)
find_package(nlohmann_json REQUIRED)
find_package(spdlog REQUIRED)
find_package(CLI11 REQUIRED)
find_package(tinyxml2 REQUIRED)
pkg_check_modules(urdfdom REQUIRED IMPORTED_TARGET urdfdom)
pkg_check_modules(orocos_kdl REQUIRED IMPORTED_TARGET orocos-kdl)
pkg_check_modules(bullet REQUIRED IMPORTED_TARGET bullet-float64)  # double precision
pkg_check_modules(luajit REQUIRED IMPORTED_TARGET luajit)
pkg_check_modules(libedit REQUIRED IMPORTED_TARGET libedit)
pkg_check_modules(sqlite3 REQUIRED IMPORTED_TARGET sqlite3)
pkg_check_modules(zstd REQUIRED IMPORTED_TARGET libzstd)
find_package(Boost 1.74 REQUIRED)  # headers of Beast and Asio
if(KADANS_TESTS)
  find_package(doctest REQUIRED)
endif()
