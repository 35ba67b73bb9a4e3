# The libraries, all of them Debian 12 packages (packages.txt).
find_package(PkgConfig REQUIRED)
find_package(fmt REQUIRED)
find_package(tomlplusplus REQUIRED)
find_package(nlohmann_json REQUIRED)
find_package(TBB REQUIRED)
find_package(GTest REQUIRED)
find_package(benchmark REQUIRED)
find_package(rapidcheck REQUIRED)
find_package(nanoflann REQUIRED)
find_package(assimp REQUIRED)
find_package(Eigen3 REQUIRED)
pkg_check_modules(hwy REQUIRED IMPORTED_TARGET libhwy)
pkg_check_modules(systemc REQUIRED IMPORTED_TARGET systemc)
# By pkg-config: OpenImageIO's CMake target names an OpenCV include folder that Debian's package lacks.
pkg_check_modules(openimageio REQUIRED IMPORTED_TARGET OpenImageIO)
find_package(FlatBuffers CONFIG REQUIRED)

add_library(Highway ALIAS PkgConfig::hwy)
add_library(OpenImage ALIAS PkgConfig::openimageio)
add_library(Glm INTERFACE)  # header only, in the system's include folder
add_library(Flatbuffers INTERFACE)
target_link_libraries(Flatbuffers INTERFACE flatbuffers::flatbuffers)
# Debian builds SystemC as C++17; its link-time check must be told so in a C++20 program.
add_library(SystemC INTERFACE)
target_link_libraries(SystemC INTERFACE PkgConfig::systemc)
target_compile_definitions(SystemC INTERFACE SC_CPLUSPLUS=201703L)
