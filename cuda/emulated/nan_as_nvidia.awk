# See nan_as_nvidia. A lane that is a NaN becomes all ones, and then loses its sign.
{ print }
/^\t(add|sub|mul|div|sqrt)(ss|ps)\t|^\tcvt(sd2ss|pd2ps)\t/ {
  if (match($0, /%xmm[0-9]+$/) == 0) { print FILENAME ":" FNR ": no register: " $0 > "/dev/stderr"; exit 1 }
  to = substr($0, RSTART)
  if ($1 ~ /ps$/) print "\tmovaps\t" to ", %xmm15\n\tcmpunordps\t%xmm15, %xmm15"
  else print "\txorps\t%xmm15, %xmm15\n\tmovss\t" to ", %xmm15\n\tcmpunordss\t%xmm15, %xmm15"
  print "\torps\t%xmm15, " to "\n\tpslld\t$31, %xmm15\n\txorps\t%xmm15, " to
}
