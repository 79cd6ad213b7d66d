# Completion of `continuo` in fish. The command itself knows what may follow (continuo --complete).
function __continuo_complete
    set -l words (commandline -opc) (commandline -ct)
    for line in ($words[1] --complete $words[2..-1] 2>/dev/null)
        switch $line
            case ':files*'
                __fish_complete_path (commandline -ct)
            case '*'
                echo $line
        end
    end
end
complete -c continuo -f -a '(__continuo_complete)'
