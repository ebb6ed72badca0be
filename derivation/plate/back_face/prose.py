"""Text of the report about the back face, by derivation step."""

ABOUT = {
    "back face": "The tensile stress is evaluated where bending makes it largest: on the back "
    "face, on the axis. For a thin plate the sum over the modes reduces to a "
    "function of $a/h$ plus a logarithm of $b/h$. The edge correction adds the "
    "stress of its bending and extension states.",
}
