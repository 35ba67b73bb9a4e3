file(GLOB scenes CONFIGURE_DEPENDS ${CMAKE_SOURCE_DIR}/traces/scenes/*.toml)
splatscope_embed(splatscope_traces ready_scenes ${scenes})

# trace_generated.h, from the schema by the FlatBuffers compiler.
find_program(FLATC flatc REQUIRED)
set(schema ${CMAKE_SOURCE_DIR}/traces/trace.fbs)
set(generated ${CMAKE_BINARY_DIR}/generated/traces)
add_custom_command(OUTPUT ${generated}/traces/trace_generated.h
  COMMAND ${FLATC} --cpp --scoped-enums -o ${generated}/traces ${schema}
  DEPENDS ${schema} VERBATIM)
target_sources(splatscope_traces PRIVATE ${generated}/traces/trace_generated.h)
target_include_directories(splatscope_traces SYSTEM PUBLIC ${generated})
