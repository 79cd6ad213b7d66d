#!/usr/bin/env bash
# web.sh unit|browser SOURCE BUILD: the tests of the page, in the folder where it was built.
set -euo pipefail
what=$1 source=$2 build=$3
cd "$build/web"
mkdir -p test
rm -rf "test/$what"
cp -r "$source/web/test/$what" test/
if [[ $what == unit ]]; then
  npm run check --silent
  npm test --silent
else
  export CONTINUO_COMMAND=$build/continuo CONTINUO_ROOT=$source CONTINUO_PICTURES=$build/pictures
  npm run browser --silent
fi
