# For Doxygen: our comments are plain "//". A word in angle brackets is no tag.
/^ *\/\//s/<([a-z_]+)>/\&lt;\1\&gt;/g
s,^( *)// ,\1/// ,
s,([;{,] +)// ,\1///< ,
