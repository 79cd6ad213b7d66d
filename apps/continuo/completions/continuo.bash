# Completion of `continuo` in bash. The command itself knows what may follow (continuo --complete).
_continuo() {
  local line word=${COMP_WORDS[COMP_CWORD]} words=("${COMP_WORDS[@]:1:COMP_CWORD}")
  # Bash takes `=` for the end of a word: put the pieces of --set=k and k=5 together again.
  if declare -F _get_comp_words_by_ref >/dev/null; then
    local cword all
    _get_comp_words_by_ref -n '=:' -c word -i cword -w all
    words=("${all[@]:1:cword}")
  fi
  COMPREPLY=()
  while IFS= read -r line; do
    case $line in
      ':files .sim')
        compopt -o filenames
        while IFS= read -r line; do COMPREPLY+=("$line"); done < <(compgen -d -- "$word"; compgen -f -X '!*.sim' -- "$word") ;;
      ':files')
        compopt -o filenames
        while IFS= read -r line; do COMPREPLY+=("$line"); done < <(compgen -f -- "$word") ;;
      *)
        if [[ $line == *= ]]; then compopt -o nospace; fi
        COMPREPLY+=("$line") ;;
    esac
  done < <("${COMP_WORDS[0]}" --complete "${words[@]}" 2>/dev/null)
  if declare -F __ltrim_colon_completions >/dev/null && [[ $word == *=* && $COMP_WORDBREAKS == *=* ]]; then
    local i head=${word%"${word##*=}"}
    for i in "${!COMPREPLY[@]}"; do COMPREPLY[i]=${COMPREPLY[i]#"$head"}; done
  fi
}
complete -F _continuo continuo
