# What the model carries with it: the machine descriptions.
file(GLOB machine_files CONFIGURE_DEPENDS ${CMAKE_SOURCE_DIR}/model/machine/*.toml)
splatscope_embed(splatscope_model machine_files ${machine_files})
