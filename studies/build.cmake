# The style and the script of report.html become report_files().
splatscope_embed(splatscope_studies report_files ${CMAKE_CURRENT_LIST_DIR}/report/report.css
                 ${CMAKE_CURRENT_LIST_DIR}/report/report.js)
