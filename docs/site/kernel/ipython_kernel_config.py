"""Settings of the kernel that tutorials run in; its warning about connections without encryption would end the build."""

get_config().IPKernelApp.log_level = "ERROR"  # noqa: F821 - defined by IPython
