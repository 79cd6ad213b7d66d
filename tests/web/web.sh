#!/usr/bin/env bash
# web.sh unit|browser SOURCE BUILD [NAME]: the tests of the page, in the folder where it was built; of those in the
# browser the file NAME.
set -euo pipefail
what=$1 source=$2 build=$3
cd "$build/web"
mkdir -p test
if [[ $what == unit ]]; then
  rm -rf test/unit
  cp -r "$source/web/test/unit" test/
  npm run check --silent
  npm test --silent
else
  export CONTINUO_COMMAND=$build/continuo CONTINUO_ROOT=$source CONTINUO_PICTURES=$build/pictures
  folder=test/browser_$4  # a separate folder, since `unit` may run at the same time
  rm -rf "$folder"
  cp -r "$source/web/test/browser" "$folder"
  node --test "$folder/$4.test.mjs"
fi
