# The programs of object_space_ewa become object_space_ewa_programs().
file(GLOB object_space_ewa_files CONFIGURE_DEPENDS ${CMAKE_CURRENT_LIST_DIR}/object_space_ewa/*.vs
                                                    ${CMAKE_CURRENT_LIST_DIR}/object_space_ewa/*.ps)
splatscope_embed(splatscope_kernels object_space_ewa_programs ${object_space_ewa_files})
