# The page of the live view: web/ is built by npm in the build folder, when its sources have changed, compressed, and
# compiled into the command. continuo_page_file is set to the compressed page where it is built.
option(CONTINUO_PAGE "Build the page of the live view into the command (needs npm)" ON)
find_program(CONTINUO_NPM npm)
find_program(CONTINUO_NODE node nodejs)
set(continuo_page_file "")
if(NOT CONTINUO_PAGE OR NOT EXISTS ${PROJECT_SOURCE_DIR}/web/package-lock.json)
  return()
endif()
if(NOT CONTINUO_NPM OR NOT CONTINUO_NODE)
  message(STATUS "npm is not there: `continuo view` will have no page")
  return()
endif()

set(page_folder ${PROJECT_BINARY_DIR}/web)
set(continuo_page_file ${PROJECT_BINARY_DIR}/page.html.gz)
file(GLOB_RECURSE page_sources CONFIGURE_DEPENDS ${PROJECT_SOURCE_DIR}/web/src/* ${PROJECT_SOURCE_DIR}/web/public/*)
file(GLOB page_settings CONFIGURE_DEPENDS ${PROJECT_SOURCE_DIR}/web/*.json ${PROJECT_SOURCE_DIR}/web/*.ts
     ${PROJECT_SOURCE_DIR}/web/*.html)

add_custom_command(
  OUTPUT ${page_folder}/installed
  COMMAND ${CMAKE_COMMAND} -E make_directory ${page_folder}
  COMMAND ${CMAKE_COMMAND} -E copy ${PROJECT_SOURCE_DIR}/web/package.json ${PROJECT_SOURCE_DIR}/web/package-lock.json
          ${page_folder}
  COMMAND ${CONTINUO_NPM} ci --no-audit --no-fund --loglevel=error --fetch-retries=5
  COMMAND ${CMAKE_COMMAND} -E touch ${page_folder}/installed
  DEPENDS ${PROJECT_SOURCE_DIR}/web/package.json ${PROJECT_SOURCE_DIR}/web/package-lock.json
  WORKING_DIRECTORY ${PROJECT_BINARY_DIR}/web
  COMMENT "Fetching what the page is built with (without it: -DCONTINUO_PAGE=OFF)"
  VERBATIM)
file(MAKE_DIRECTORY ${page_folder})

add_custom_command(
  OUTPUT ${continuo_page_file}
  COMMAND ${CMAKE_COMMAND} -E rm -rf ${page_folder}/src
  COMMAND ${CMAKE_COMMAND} -E copy_directory ${PROJECT_SOURCE_DIR}/web/src ${page_folder}/src
  COMMAND ${CMAKE_COMMAND} -E copy ${page_settings} ${page_folder}
  COMMAND ${CONTINUO_NPM} run build --silent
  COMMAND ${CONTINUO_NODE} -e
          "const fs = require('fs'); fs.writeFileSync(process.argv[1], require('zlib').gzipSync(fs.readFileSync('dist/index.html'), {level: 9}))"
          ${continuo_page_file}
  DEPENDS ${page_folder}/installed ${page_sources} ${page_settings}
  WORKING_DIRECTORY ${page_folder}
  COMMENT "Building the page of the live view"
  VERBATIM)
