# One target a top folder. Sources are found by name: x.cpp belongs to the library, x_test.cpp to its tests
# (GoogleTest; every TEST is a CTest process of its own), x_bench.cpp to its benchmarks (Google Benchmark).
find_program(CCACHE ccache)
if(CCACHE)
  set(CMAKE_CXX_COMPILER_LAUNCHER ${CCACHE})
endif()
include(GoogleTest)

add_library(splatscope_options INTERFACE)
# The same bits from every build and every SIMD target: -ffp-contract=off, and no vectoriser of straight-line code, as
# that of GCC 12 leaves out the rounding of a vector of doubles to float and back (what SIMD we want, Highway writes).
target_compile_options(splatscope_options INTERFACE -Wall -Wextra -Wconversion -ffp-contract=off
                                                    -fno-tree-slp-vectorize)
if(SPLATSCOPE_SANITIZE)
  set(sanitizers ${SPLATSCOPE_SANITIZE})
  if(SPLATSCOPE_SANITIZE STREQUAL address)
    set(sanitizers address,undefined,float-cast-overflow)  # the last is in no group of GCC
  endif()
  target_compile_options(splatscope_options INTERFACE -fsanitize=${sanitizers} -fno-sanitize-recover=all
                                                     -fno-omit-frame-pointer -g1)
  target_link_options(splatscope_options INTERFACE -fsanitize=${sanitizers})
endif()
if(SPLATSCOPE_COVERAGE)
  # Threads count together; without inlining a line is counted where it stands.
  target_compile_options(splatscope_options INTERFACE --coverage -fprofile-update=atomic -O1 -fno-inline)
  # Highway includes files once more by the links of splatscope_headers: lines count where they are.
  target_compile_options(splatscope_options INTERFACE
                         -fprofile-prefix-map=${CMAKE_BINARY_DIR}/include/model/model/=${CMAKE_SOURCE_DIR}/model/)
  target_link_options(splatscope_options INTERFACE --coverage)
endif()

if(SPLATSCOPE_FUZZ)
  target_compile_options(splatscope_options INTERFACE -fsanitize=fuzzer-no-link,address,undefined
                                                     -fno-sanitize-recover=undefined)
  target_link_options(splatscope_options INTERFACE -fsanitize=address,undefined)
endif()

# include/FOLDER/ holds a link to FOLDER alone, so a target finds only the headers of what it links.
function(splatscope_headers folder target)
  set(root ${CMAKE_BINARY_DIR}/include/${folder})
  file(MAKE_DIRECTORY ${root})
  file(CREATE_LINK ${CMAKE_SOURCE_DIR}/${folder} ${root}/${folder} SYMBOLIC)
  target_include_directories(${target} PUBLIC ${root})
endfunction()

function(splatscope_sources folder suffix variable)
  file(GLOB_RECURSE found CONFIGURE_DEPENDS ${CMAKE_SOURCE_DIR}/${folder}/*.cpp)
  if(suffix)
    list(FILTER found INCLUDE REGEX "_${suffix}\\.cpp$")
  else()
    list(FILTER found EXCLUDE REGEX "(_(test|bench|fuzz|module)|/main)\\.cpp$")
  endif()
  set(${variable} ${found} PARENT_SCOPE)
endfunction()

function(splatscope_library folder)
  splatscope_sources(${folder} "" sources)
  add_library(splatscope_${folder} STATIC ${sources})
  target_link_libraries(splatscope_${folder} PUBLIC ${ARGN} PRIVATE splatscope_options)
  splatscope_headers(${folder} splatscope_${folder})
  if(EXISTS ${CMAKE_SOURCE_DIR}/${folder}/build.cmake)
    include(${CMAKE_SOURCE_DIR}/${folder}/build.cmake)
  endif()
endfunction()

# Functions of FOLDER call each other across its files once a triangle: the program and the benchmarks are linked as if
# it were one file (by GCC). Tests and fuzzers take the plain half of its objects, with -fno-lto: they link at once;
# those in tests/ run the program as it is linked.
function(splatscope_link_as_one folder)
  if(CMAKE_CXX_COMPILER_ID STREQUAL GNU AND NOT SPLATSCOPE_SANITIZE AND NOT SPLATSCOPE_COVERAGE)
    target_compile_options(splatscope_${folder} PRIVATE -flto=auto -ffat-lto-objects)
  endif()
endfunction()

# FOLDER/NAME_module.cpp, a library that the folder's own loads from beside the program when it is needed.
function(splatscope_module folder name)
  add_library(${name}_module MODULE ${CMAKE_SOURCE_DIR}/${folder}/${name}_module.cpp)
  target_link_libraries(${name}_module PRIVATE ${ARGN} splatscope_options)
  target_include_directories(${name}_module PRIVATE ${CMAKE_BINARY_DIR}/include/${folder})
  target_compile_definitions(splatscope_${folder} PRIVATE SPLATSCOPE_MODULE="$<TARGET_FILE_NAME:${name}_module>")
  add_dependencies(splatscope_${folder} ${name}_module)
endfunction()

# The program is FOLDER/main.cpp; the rest is a library, so that tests can run a command without starting the program.
function(splatscope_program folder)
  splatscope_library(${folder} ${ARGN})
  target_compile_options(splatscope_${folder} PRIVATE $<$<CONFIG:Release>:-O1>)  # it only calls the others
  add_executable(splatscope ${CMAKE_SOURCE_DIR}/${folder}/main.cpp)
  target_link_libraries(splatscope PRIVATE splatscope_${folder} splatscope_options)
endfunction()

function(splatscope_tests folder)
  splatscope_sources(${folder} test sources)
  add_executable(${folder}_tests ${sources})
  target_link_libraries(${folder}_tests PRIVATE ${ARGN} splatscope_options GTest::gtest_main rapidcheck)
  # Most of a build from nothing is tests, and this makes it a fifth shorter; the libraries are optimised as ever.
  target_compile_options(${folder}_tests PRIVATE $<$<CONFIG:Release>:-O1>)
  target_link_options(${folder}_tests PRIVATE -fno-lto)
  target_compile_definitions(${folder}_tests PRIVATE SPLATSCOPE_SOURCE="${CMAKE_SOURCE_DIR}"
                                                     SPLATSCOPE_PROGRAM="$<TARGET_FILE:splatscope>")
  set(seconds 600)
  if(SPLATSCOPE_SANITIZE)
    set(seconds 3600)
  endif()
  gtest_discover_tests(${folder}_tests DISCOVERY_TIMEOUT 60 PROPERTIES TIMEOUT ${seconds})
endfunction()

function(splatscope_benchmarks folder)
  splatscope_sources(${folder} bench sources)
  if(NOT SPLATSCOPE_SANITIZE)
    add_executable(${folder}_benchmarks ${sources})
    target_link_libraries(${folder}_benchmarks PRIVATE ${ARGN} splatscope_options benchmark::benchmark_main)
    target_compile_definitions(${folder}_benchmarks PRIVATE SPLATSCOPE_SOURCE="${CMAKE_SOURCE_DIR}")
  endif()
endfunction()

# x_fuzz.cpp becomes the fuzzer x_fuzz: libFuzzer's where SPLATSCOPE_FUZZ, else a short run over tests/fuzz/x (a test).
function(splatscope_fuzzers folder)
  splatscope_sources(${folder} fuzz sources)
  foreach(source ${sources})
    get_filename_component(name ${source} NAME_WE)
    string(REGEX REPLACE "_fuzz$" "" corpus ${name})
    if(SPLATSCOPE_FUZZ)
      add_executable(${name} ${source})
      target_link_options(${name} PRIVATE -fsanitize=fuzzer)
    else()
      add_executable(${name} ${source} ${CMAKE_SOURCE_DIR}/tests/fuzz/short_run.cpp)
      # Seconds: a minute for all eight.
      add_test(NAME ${name} COMMAND ${name} ${CMAKE_SOURCE_DIR}/tests/fuzz/${corpus} 8)
    endif()
    target_link_libraries(${name} PRIVATE ${ARGN} splatscope_options)
    # SystemC's library looks for sc_main, which is where it is used.
    target_link_options(${name} PRIVATE -fno-lto LINKER:--as-needed)
  endforeach()
endfunction()

# Text files (programs, machines) become a table in the program: splatscope reads no file of its own at run time.
# Writes NAME.cpp defining `std::span<const splatscope::EmbeddedFile> NAME()`.
function(splatscope_embed target name)
  set(generated ${CMAKE_BINARY_DIR}/embedded/${name}.cpp)
  set(text "#include \"model/embedded_file.h\"\n\nnamespace splatscope {\nstd::span<const EmbeddedFile> ${name}() {\n  static constexpr EmbeddedFile files[] = {\n")
  foreach(file ${ARGN})
    set_property(DIRECTORY ${CMAKE_SOURCE_DIR} APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS ${file})
    file(READ ${file} content)
    get_filename_component(base ${file} NAME)
    string(APPEND text "      {\"${base}\", R\"embedded(${content})embedded\"},\n")
  endforeach()
  string(APPEND text "  };\n  return files;\n}\n}  // namespace splatscope\n")
  file(CONFIGURE OUTPUT ${generated} CONTENT "${text}" @ONLY)
  target_sources(${target} PRIVATE ${generated})
endfunction()
