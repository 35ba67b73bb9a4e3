# The programs become embedded_programs().
file(GLOB programs CONFIGURE_DEPENDS ${CMAKE_CURRENT_LIST_DIR}/*/*.vs ${CMAKE_CURRENT_LIST_DIR}/*/*.ps)
splatscope_embed(splatscope_kernels embedded_programs ${programs})
